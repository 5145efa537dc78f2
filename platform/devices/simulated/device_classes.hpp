// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/device_limits.hpp"

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// Limits of device classes to simulate. Forces and stiffnesses are published by makers and users.
/// Mass, damping, friction and quantum are assumed values of the usual size; the damping allows the
/// stiffness at the usual rate of such a device. None is a measurement of a product: measure your
/// own (docs/stability.md).

/// Rotation limits of a fictitious desk device that makes a torque. Inertia, damping and stiffness
/// are those of the default DeviceLimits at a lever of 3.2 cm (the root of 0.001 m^2). The largest
/// torque is that of commercial wrists.
inline constexpr RotationLimits kDeskRotation{.is_measured = true,
                                              .torque_max_nm = 0.5,
                                              .inertia_kg_m2 = 1e-4,
                                              .damping_nm_s_per_rad = 1e-3,
                                              .friction_nm = 0.0,
                                              .quantum_rad = 0.0,
                                              .slew_max_nm_per_s = 1'000.0,
                                              .stiffness_max_nm_per_rad = 3.0,
                                              .added_damping_max_nm_s_per_rad = 5e-3};
inline constexpr DeviceLimits kDeskClass{.rotation = kDeskRotation};

/// A small desktop arm with a stylus, which measures its rotation and makes no torque.
inline constexpr DeviceLimits kTouchClass{.mass_kg = 0.045,
                                          .damping_n_s_per_m = 0.25,
                                          .friction_n = 0.1,
                                          .quantum_m = 55e-6,
                                          .delay_s = 0.0,
                                          .force_max_n = 3.3,
                                          .slew_max_n_per_s = 6'600.0,
                                          .stiffness_max_n_per_m = 400.0,
                                          .added_damping_max_n_s_per_m = 2.0,
                                          .rotation = {.is_measured = true,
                                                       .inertia_kg_m2 = 2e-5,
                                                       .damping_nm_s_per_rad = 5e-5,
                                                       .friction_nm = 1e-4,
                                                       .quantum_rad = 1e-3}};

/// A stiff parallel mechanism, whose handle doesn't rotate.
inline constexpr DeviceLimits kOmegaClass{.mass_kg = 0.2,
                                          .damping_n_s_per_m = 1.7,
                                          .friction_n = 0.05,
                                          .quantum_m = 10e-6,
                                          .delay_s = 0.0,
                                          .force_max_n = 12.0,
                                          .slew_max_n_per_s = 24'000.0,
                                          .stiffness_max_n_per_m = 5'000.0,
                                          .added_damping_max_n_s_per_m = 10.0};

/// A larger parallel mechanism, whose handle doesn't rotate.
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
