// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/export/field_sink.hpp"
#include "platform/recording/frame_decoder.hpp"
#include "platform/recording/recording_format.hpp"
#include "rt_core/records/frame_output.hpp"

#include <cstddef>
#include <cstdint>

// What is told of a run: one function for each kind of thing. SI; world frame but where a name says
// otherwise. Any thread, but not the haptic one: sinks allocate.
namespace tactus
{

/// A frame of a recording and what it returned when it was replayed.
struct ReplayedFrameView
{
    std::uint64_t number{0};       ///< From 0.
    std::int64_t first_time_ns{0}; ///< RecordedFrame::now_ns of frame 0.
    const RecordedFrame& given;
    const FrameOutput& returned;
};

void tell_run(FieldSink& sink, const RecordedSetup& setup);
void tell_tool_spec(FieldSink& sink, const ToolSpec& tool);
/// `number` is of RecordedSetup::objects.
void tell_object(FieldSink& sink, const RecordedSetup& setup, std::size_t number);
void tell_model_spec(FieldSink& sink, const RecordedSetup& setup, std::size_t number);

/// Time, work, faults and scene.
void tell_frame(FieldSink& sink, const ReplayedFrameView& frame);
void tell_tool(FieldSink& sink, const ReplayedFrameView& frame, std::size_t tool);
void tell_pair(FieldSink& sink, const PairOutput& pair);
void tell_model(FieldSink& sink, const ModelOutput& model);
void tell_change(FieldSink& sink, const SceneChange& change);

} // namespace tactus
