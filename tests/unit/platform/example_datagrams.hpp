// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/udp/datagram.hpp"

/// Datagrams of each kind, with all values different.
namespace tactus::test
{

inline udp::DescribeDatagram example_description()
{
    udp::DescribeDatagram datagram{{3, 0, 1}, {}};
    datagram.info.name = "desk 1";
    datagram.info.limits = {.mass_kg = 0.1,
                            .damping_n_s_per_m = 0.2,
                            .friction_n = 0.3,
                            .quantum_m = 0.4,
                            .delay_s = 0.05,
                            .force_max_n = 6.0,
                            .slew_max_n_per_s = 7.0,
                            .stiffness_max_n_per_m = 8.0,
                            .added_damping_max_n_s_per_m = 9.0,
                            .rotation = {.is_measured = true,
                                         .torque_max_nm = 17.0,
                                         .inertia_kg_m2 = 18.0,
                                         .damping_nm_s_per_rad = 19.0,
                                         .friction_nm = 20.0,
                                         .quantum_rad = 21.0,
                                         .slew_max_nm_per_s = 22.0,
                                         .stiffness_max_nm_per_rad = 23.0,
                                         .added_damping_max_nm_s_per_rad = 24.0}};
    datagram.info.gripper_force_max_n = 25.0;
    datagram.info.workspace_centre_world_m = {10.0, 11.0, 12.0};
    datagram.info.workspace_radius_m = 13.0;
    datagram.info.speed_max_m_per_s = 14.0;
    datagram.info.rate_min_hz = 15;
    datagram.info.rate_max_hz = 16;
    return datagram;
}

inline udp::SampleDatagram example_sample()
{
    udp::SampleDatagram datagram;
    datagram.address = {3, 4, 5};
    datagram.position_m = {0.1, -0.2, 0.3};
    datagram.velocity_m_per_s = {1.0, 2.0, -3.0};
    datagram.time_ns = 1'234'567;
    datagram.valid = true;
    datagram.deadman_held = false;
    datagram.rotation = {0.6, 0.0, -0.0, 0.8};
    datagram.angular_velocity_rad_per_s = {4.0, 5.0, -6.0};
    datagram.gripper_m = 0.04;
    datagram.buttons = 0x8000'0001U;
    return datagram;
}

inline udp::ForceDatagram example_force()
{
    return {{3, 4, 6}, {1.5, -2.5, 3.5}, DeviceState::brake, 5, {0.1, -0.2, 0.3}, -0.4};
}

} // namespace tactus::test
