// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/recorded_motion.hpp"

#include "rt_core/base/assert.hpp"

#include <cmath>

namespace tactus::hrtc
{

Result<ReplayDeviceOptions, Refusal> read_recorded_motion(const std::string& path, std::size_t tool)
{
    const auto recording = Recording::read(path);
    if (!recording)
    {
        return recording.error();
    }
    const RecordedSetup& setup = recording.value().setup();
    const std::size_t played = tool < setup.tools.size() ? tool : 0;
    ReplayDeviceOptions options;
    options.rate_hz = std::llround(1e9 / static_cast<double>(setup.period_ns));
    options.limits.force_max_n = setup.tools[played].force_max_n;
    options.readings.reserve(recording.value().frame_count());
    FrameDecoder decoder(recording.value().shape());
    for (ByteReader reader(recording.value().frames()); !reader.at_end();)
    {
        const char* fault = decoder.decode(reader);
        TACTUS_ASSERT(fault == nullptr); // The recording was checked as a whole.
        const ToolState& state = decoder.frame().tools[played];
        options.readings.push_back(
            {state.position_m, MonotonicTime{state.sample_time_ns}, state.valid});
    }
    return options;
}

} // namespace tactus::hrtc
