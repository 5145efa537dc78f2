// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/export/field_sink.hpp"
#include "platform/recording/frame_decoder.hpp"
#include "platform/recording/recording_format.hpp"
#include "rt_core/records/frame_output.hpp"

#include <cstddef>
#include <cstdint>

// Functions that write the fields of a run, one for each kind of object. SI units; world frame
// unless a name says otherwise. Any thread, but not the haptic one: sinks allocate.
namespace tactus
{

/// A frame of a recording and its output in the replay.
struct ReplayedFrameView
{
    std::uint64_t number{0};       ///< Number of the frame, from 0.
    std::int64_t first_time_ns{0}; ///< Value of RecordedFrame::now_ns of frame 0.
    const RecordedFrame& given;
    const FrameOutput& returned;
};

void tell_run(FieldSink& sink, const RecordedSetup& setup);
void tell_tool_spec(FieldSink& sink, const ToolSpec& tool);
/// `number`: index in RecordedSetup::objects.
void tell_object(FieldSink& sink, const RecordedSetup& setup, std::size_t number);
void tell_model_spec(FieldSink& sink, const RecordedSetup& setup, std::size_t number);

/// Writes time, work, faults and scene.
void tell_frame(FieldSink& sink, const ReplayedFrameView& frame);
void tell_tool(FieldSink& sink, const ReplayedFrameView& frame, std::size_t tool);
void tell_pair(FieldSink& sink, const PairOutput& pair);
void tell_model(FieldSink& sink, const ModelOutput& model);
void tell_change(FieldSink& sink, const SceneChange& change);

} // namespace tactus
