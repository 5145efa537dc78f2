// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/dds/participants.hpp"

#include <dds/dds.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace tactus::dds
{

/// Text of a bounded string in a sample, valid as long as the sample.
template <std::size_t Size>
[[nodiscard]] std::string_view text_of(const char (&text)[Size]) noexcept // NOLINT: idlc's type.
{
    return {static_cast<const char*>(text), ::strnlen(static_cast<const char*>(text), Size)};
}

/// Identity of the controller that a sample states: the GUID of its participant.
template <typename Sample>
[[nodiscard]] ControllerId controller_of(const Sample& sample) noexcept
{
    ControllerId id{};
    std::memcpy(id.data(), sample.controller, id.size());
    return id;
}

/// True if a sample reports only the end of its instance; a genuine writer of the sample ended it.
/// If untaken data preceded the end, they come first, with the state of the end but their own
/// writer.
[[nodiscard]] inline bool tells_end(const dds_sample_info_t& info) noexcept
{
    return info.instance_state != DDS_ALIVE_INSTANCE_STATE && !info.valid_data;
}

/// Maximum number of samples that take_each() takes in one call of DDS.
inline constexpr std::uint32_t kTakenAtOnce = 16;

/// Takes up to `samples_max` samples, rounded up to kTakenAtOnce, and calls `visit(const Sample&,
/// const dds_sample_info_t&)` for each. Samples are on loan from Cyclone, which truncates to, or
/// with `_release` set frees, a buffer of ours. A sample without valid_data has only its key
/// fields. Returns the number of samples taken.
template <typename Sample, typename Visit>
std::size_t take_each(std::int32_t reader, std::size_t samples_max, Visit&& visit)
{
    constexpr std::uint32_t batch = kTakenAtOnce;
    std::size_t taken = 0;
    while (taken < samples_max)
    {
        std::array<void*, batch> samples{}; // Null pointers request a loan.
        std::array<dds_sample_info_t, batch> infos{};
        const std::int32_t count =
            dds_take(reader, samples.data(), infos.data(), samples.size(), batch);
        for (std::size_t i = 0; count > 0 && i < static_cast<std::size_t>(count); ++i)
        {
            visit(*static_cast<const Sample*>(samples[i]), infos[i]);
        }
        if (count > 0)
        {
            dds_return_loan(reader, samples.data(), count);
            taken += static_cast<std::size_t>(count);
        }
        if (count < static_cast<std::int32_t>(batch))
        {
            break;
        }
    }
    return taken;
}

} // namespace tactus::dds
