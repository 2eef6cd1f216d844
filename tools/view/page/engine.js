// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where surfaces come from. An engine has
//   takesFiles        whether the reader gives it a file, by open(file)
//   open(file)        -> info
//   info()            -> what FrameSource::info() tells (frame_source.hpp)
//   frame(request, signal) -> an ArrayBuffer in the layout of frame_reply.hpp; an AbortSignal ends
//                        the request where the engine waits for frames
// Each returns a promise, which fails with an Error whose message is a sentence for the reader.
// A page of files alone has another engine.js.
export { ServerEngine as Engine } from './server_engine.js';
