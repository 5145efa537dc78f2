// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/simulated/simulated_device.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/work_budget.hpp"
#include "transport/material_text.hpp"

#include <cstdint>

// Any thread: constants.
namespace tactus::hrtc
{

/// Allowed values of a run's option, from `low` to `high`.
template <typename Number>
struct OptionRange
{
    Number low;
    Number high;
};

/// Ranges of the members of Options, for the command line and for programs that set them.
inline constexpr OptionRange<std::int64_t> kRateRange_hz{SimulatedDeviceOptions::kRateMinHz,
                                                         SimulatedDeviceOptions::kRateMaxHz};
inline constexpr OptionRange<double> kDurationRange_s{0.1, 86'400.0};
inline constexpr OptionRange<double> kPoolRange_mib{0.25, 4'096.0};
inline constexpr OptionRange<double> kCacheRange_mib{0.05, 4'096.0};
inline constexpr OptionRange<std::uint32_t> kSplitsRange{1, kMaxSplitsPerFrame};
inline constexpr OptionRange<std::uint32_t> kEditFacesRange{0, kMaxAddedFaces};
inline constexpr OptionRange<double> kFrameBudgetRange_us{1e-3 * WorkBudget::kLeast, 10'000.0};
inline constexpr OptionRange<double> kStiffnessRange_n_per_m{1.0, kStiffest_n_per_m};
inline constexpr OptionRange<double> kAngularStiffnessRange_nm_per_rad{kSoftest_nm_per_rad,
                                                                       kStiffest_nm_per_rad};
inline constexpr OptionRange<double> kShadingRange_m{kShadingWidthMin_m, kShadingWidthMax_m};
inline constexpr OptionRange<double> kForceToleranceRange_n{0.0, kForceToleranceMax_n};
inline constexpr OptionRange<double> kSlewRange_per_ms{kSlewShareMin_per_ms, 1.0};
inline constexpr OptionRange<std::uint32_t> kClutchRange{0, kButtons - 1U};
inline constexpr OptionRange<double> kSpeedLimitRange_m_per_s{0.01, 100.0};
inline constexpr OptionRange<double> kObjectSpeedRange_m_per_s{0.001, 100.0};
inline constexpr OptionRange<double> kProxySpeedRange_m_per_s{0.001, 100.0};
inline constexpr OptionRange<int> kDomainRange{0, 232};
inline constexpr OptionRange<double> kWaitRange_s{0.1, 3'600.0};
inline constexpr OptionRange<std::uint32_t> kSupervisorRange{2, 1'000};
inline constexpr OptionRange<int> kCpuRange{0, 1'023};

} // namespace tactus::hrtc
