// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <dds/dds.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace tactus::dds
{

/// Text of a bounded string in a sample, up to its end or its capacity. Valid as long as the
/// sample.
template <std::size_t Size>
[[nodiscard]] std::string_view text_of(const char (&text)[Size]) noexcept // NOLINT: idlc's type.
{
    return {static_cast<const char*>(text), ::strnlen(static_cast<const char*>(text), Size)};
}

/// True if a sample reports the end of its instance; its writer is the one that ended it, if that
/// writer is genuine. If the instance was ended before its last data were taken, these data show
/// the end but name their own writer.
[[nodiscard]] inline bool tells_end(const dds_sample_info_t& info) noexcept
{
    return info.instance_state != DDS_ALIVE_INSTANCE_STATE && !info.valid_data;
}

/// Samples that take_each() takes with one call of DDS.
inline constexpr std::uint32_t kTakenAtOnce = 16;

/// Takes up to `samples_max` samples and calls `visit(const Sample&, const dds_sample_info_t&)` for
/// each. The samples are on loan from Cyclone: a buffer of ours would be silently truncated to or,
/// with `_release` set, freed by Cyclone. A sample without valid_data has only key fields. Returns
/// the number of samples taken.
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
