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

/// The hands of the last frames, for when one fails and nothing was recorded. They stay as they are
/// until somebody asks: coded they would cost the haptic thread ten times as much.
class LastInputs
{
public:
    /// Some seconds of one tool, 2 MiB.
    static constexpr std::size_t kUsualSamples = 4'096;

    /// So many samples of all tools.
    explicit LastInputs(std::size_t tools, std::size_t samples = kUsualSamples);

    /// Haptic thread, after each run: forgets the oldest for it. Allocates nothing. `devices`: one
    /// a tool. Scene changes are left out.
    void keep(const FrameInput& input, std::span<const DeviceRecord> devices) noexcept;

    /// Any thread once nothing is kept any more, not the haptic one: codes all, in order.
    void write_to(RecordingWriter& writer) const;

private:
    struct Frame
    {
        std::int64_t now_ns{0};
        Budgets budgets;
    };

    std::size_t tools_;
    std::vector<Frame> frames_;
    std::vector<ToolState> states_; ///< Those of a frame in a row, as are
    std::vector<DeviceRecord> devices_;
    std::size_t next_{0}; ///< Of the frames.
    bool is_full_{false};
};

} // namespace tactus
