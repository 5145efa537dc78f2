// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/frame_encoder.hpp"
#include "platform/recording/recording_writer.hpp"
#include "rt_core/records/device_record.hpp"
#include "rt_core/records/frame_input.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus
{

/// Inputs of the last frames, kept for a failure in a run without a recording. Only write_to()
/// encodes them: encoding would cost the haptic thread ten times as much.
class LastInputs
{
public:
    /// Default capacity: 4 s of one tool at 1 kHz, 2 MiB.
    static constexpr std::size_t kUsualSamples = 4'096;

    /// `samples`: capacity, counted in samples of single tools; at least one frame is kept.
    explicit LastInputs(std::size_t tools, std::size_t samples = kUsualSamples);

    /// Haptic thread, after each run: keeps a frame without its scene changes; if full, drops the
    /// oldest. Allocates nothing. `devices`: one record a tool.
    void keep(const FrameInput& input, std::span<const DeviceRecord> devices) noexcept;

    /// Any thread except the haptic one, once no more frames are kept: adds all kept frames to
    /// `writer`, oldest first.
    void write_to(RecordingWriter& writer) const;

private:
    struct Frame
    {
        std::int64_t now_ns{0};
        Budgets budgets;
    };

    std::size_t tools_;
    std::vector<Frame> frames_;
    std::vector<ToolState> states_; ///< States, `tools_` a frame; devices_ has the same order.
    std::vector<DeviceRecord> devices_;
    std::size_t next_{0}; ///< Index of the frame that is overwritten next.
    bool is_full_{false};
};

} // namespace tactus
