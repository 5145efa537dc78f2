// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/device_limits.hpp"

namespace tactus
{

/// Three kinds of device to simulate. Force and stiffness are those that makers and users give;
/// mass, damping, friction and quantum are assumed, of the order of such mechanisms, with a damping
/// that carries the stiffness at the rate that such a device is sold for. None is a measurement of
/// a product: measure your own (docs/stability.md).

/// A small desktop arm with a stylus.
inline constexpr DeviceLimits kTouchClass{.mass_kg = 0.045,
                                          .damping_n_s_per_m = 0.25,
                                          .friction_n = 0.1,
                                          .quantum_m = 55e-6,
                                          .delay_s = 0.0,
                                          .force_max_n = 3.3,
                                          .slew_max_n_per_s = 6'600.0,
                                          .stiffness_max_n_per_m = 400.0,
                                          .added_damping_max_n_s_per_m = 2.0};

/// A stiff parallel mechanism.
inline constexpr DeviceLimits kOmegaClass{.mass_kg = 0.2,
                                          .damping_n_s_per_m = 1.7,
                                          .friction_n = 0.05,
                                          .quantum_m = 10e-6,
                                          .delay_s = 0.0,
                                          .force_max_n = 12.0,
                                          .slew_max_n_per_s = 24'000.0,
                                          .stiffness_max_n_per_m = 5'000.0,
                                          .added_damping_max_n_s_per_m = 10.0};

/// A larger one.
inline constexpr DeviceLimits kDeltaClass{.mass_kg = 0.25,
                                          .damping_n_s_per_m = 1.7,
                                          .friction_n = 0.1,
                                          .quantum_m = 20e-6,
                                          .delay_s = 0.0,
                                          .force_max_n = 20.0,
                                          .slew_max_n_per_s = 40'000.0,
                                          .stiffness_max_n_per_m = 5'000.0,
                                          .added_damping_max_n_s_per_m = 10.0};

} // namespace tactus
