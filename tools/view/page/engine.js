// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where surfaces come from. An engine has
//   takesFiles        whether the reader gives it a file, by open(file)
//   open(file)        -> info
//   info()            -> what Explorer::info() tells (explorer.hpp)
//   frame(request)    -> an ArrayBuffer in the layout of frame_reply.hpp
// Each returns a promise, which fails with an Error whose message is a sentence for the reader.
// A page of files alone has another engine.js.
export { ServerEngine as Engine } from './server_engine.js';
