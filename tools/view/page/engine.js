// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where surfaces come from. An engine has
//   takesFiles        whether the reader gives it files, by open()
//   stopsCheaply      whether a frame that is aborted costs the next one nothing
//   open(files, choice, signal) -> info, of files chosen together and of one volume in them: choice
//                     has frame, component and array, as the choice in the info of the last one
//   info()            -> what FrameSource::info() tells (frame_source.hpp)
//   frame(request, signal) -> an ArrayBuffer in the layout of frame_reply.hpp
//   pulse(signal)     -> what FrameSource::pulse() tells, at once, also while a frame is drawn
// Each returns a promise, which fails with an Error whose message is a sentence for the reader, and
// whose isLost says that the engine is not there any more. An AbortSignal ends the work itself; the
// promise then fails, too.
// A page of files alone has another engine.js.
export { ServerEngine as Engine } from './server_engine.js';
