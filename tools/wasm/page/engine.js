// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The engine of a page that opens files itself.
export { WasmEngine as Engine } from './wasm_engine.js';
