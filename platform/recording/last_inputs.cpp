// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/last_inputs.hpp"

#include "rt_core/base/assert.hpp"

#include <algorithm>

namespace tactus
{

LastInputs::LastInputs(std::size_t tools, std::size_t samples)
    : tools_(tools)
    , frames_(std::max<std::size_t>(samples / tools, 1))
    , states_(frames_.size() * tools)
    , devices_(frames_.size() * tools)
{
}

void LastInputs::keep(const FrameInput& input, std::span<const DeviceRecord> devices) noexcept
{
    TACTUS_ASSERT(input.tools.size() == tools_);
    TACTUS_ASSERT(devices.size() == tools_);
    frames_[next_] = {input.now_ns, input.budgets};
    for (std::size_t i = 0; i < tools_; ++i)
    {
        states_[next_ * tools_ + i] = input.tools[i];
        devices_[next_ * tools_ + i] = devices[i];
    }
    ++next_;
    if (next_ == frames_.size())
    {
        next_ = 0;
        is_full_ = true;
    }
}

void LastInputs::write_to(RecordingWriter& writer) const
{
    FrameEncoder encoder;
    const std::size_t count = is_full_ ? frames_.size() : next_;
    for (std::size_t i = 0; i < count; ++i)
    {
        const std::size_t at = is_full_ ? (next_ + i) % count : i;
        const Frame& frame = frames_[at];
        const std::span states = std::span(states_).subspan(at * tools_, tools_);
        writer.add_frame(encoder.encode_given({{states, {}, frame.budgets, frame.now_ns},
                                               {},
                                               std::span(devices_).subspan(at * tools_, tools_)}));
    }
}

} // namespace tactus
