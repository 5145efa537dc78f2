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

/// Device poses of the last frames, for a failure in a run without a recording. They are coded only
/// on request: coding would cost the haptic thread ten times as much.
class LastInputs
{
public:
    /// Number of samples: some seconds of one tool, 2 MiB.
    static constexpr std::size_t kUsualSamples = 4'096;

    /// `samples`: number of samples of all tools.
    explicit LastInputs(std::size_t tools, std::size_t samples = kUsualSamples);

    /// Haptic thread, after each run: keeps a frame and drops the oldest. Allocates nothing.
    /// `devices`: one a tool. Scene changes are left out.
    void keep(const FrameInput& input, std::span<const DeviceRecord> devices) noexcept;

    /// Any thread except the haptic one, once no more frames are kept: codes all, in order.
    void write_to(RecordingWriter& writer) const;

private:
    struct Frame
    {
        std::int64_t now_ns{0};
        Budgets budgets;
    };

    std::size_t tools_;
    std::vector<Frame> frames_;
    std::vector<ToolState> states_; ///< States, those of a frame in a row, like devices_.
    std::vector<DeviceRecord> devices_;
    std::size_t next_{0}; ///< Index of the next frame.
    bool is_full_{false};
};

} // namespace tactus
