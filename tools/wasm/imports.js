// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tells Emscripten's linker the functions that the page gives to the core (page/volume_module.js).
mergeInto(LibraryManager.library, { tell(doing, share) {} });
