// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/device_limits.hpp"

#include <array>
#include <cstdint>

namespace tactus
{

/// Sent forces and their times, for a device that holds each until the next one arrives,
/// DeviceLimits::delay_s later.
class SentForces
{
public:
    /// `delay_periods`: the device's delay, whole or not.
    explicit SentForces(double delay_periods) noexcept : delay_(delay_periods) {}

    /// True if no force at the device is older than those kept.
    [[nodiscard]] bool knows_delay() const noexcept { return delay_ <= kForcesUnderWay - 1; }
    void send(const Vec3& force_n) noexcept TACTUS_NONBLOCKING;
    /// Replaces the newest force.
    void replace_newest(const Vec3& force_n) noexcept { sent_[0].force_n = force_n; }
    /// Mean over time of the force at the device since the newest was sent, `elapsed_periods` > 0
    /// ago. Call it once before each send().
    [[nodiscard]] Vec3 mean_since(std::uint32_t elapsed_periods) noexcept TACTUS_NONBLOCKING;

private:
    struct Sent
    {
        Vec3 force_n{0.0, 0.0, 0.0};
        double periods{0.0}; ///< Periods until the next one was sent.
    };

    double delay_;
    std::array<Sent, kForcesUnderWay> sent_{}; ///< Newest first.
};

/// Observes the energy at the port between force and device (time-domain passivity: Hannaford and
/// Ryu 2002), in contact and across contacts.
///
/// A held force does F . (x[k] - x[k-1]) of work, exactly, for any motion in between. A passive
/// wall gives back no more than it holds: the energy of its spring. The observed energy E is
/// what the wall gave or holds beyond its input, less the device's own losses meanwhile:
///
///     E[k] = max(0, E[k-1] + work + held[k] - held[k-1] - b dx^2 / dt - f |dx|)
///
/// If a wall is moved, its work is F . (dx - its own displacement): the rest is done by those who
/// move it.
///
/// Each sampled wall generates some of it: K (v T)^2 / 2 when it is entered between two samples,
/// and K dx^2 / 2 in each period, which a wall within stiffness_limit() loses in b again. Any
/// further growth is removed by the controller. The observed energy is at least 0, so that energy
/// lost long ago hides nothing; unlike Hannaford and Ryu's sum, which a long contact makes large.
///
/// Work and losses are of measured positions. A position that toggles between two quanta adds the
/// same square to the energy that the wall generates and to that which b dissipates. So it doesn't
/// accumulate within the limit. Haptic thread.
class PassivityObserver
{
public:
    PassivityObserver(const DeviceLimits& device, double period_s) noexcept;

    /// Adds the device's motion under `force_n`, the mean of the forces that it held meanwhile. The
    /// work along `carried_m`, the displacement of a moved wall, isn't the wall's.
    /// - `elapsed_s` > 0.
    void observe(const Vec3& force_n, const Vec3& displacement_m, double elapsed_s,
                 const Vec3& carried_m = Vec3(0.0, 0.0, 0.0)) noexcept TACTUS_NONBLOCKING;
    /// Sets the spring's energy; called after observe().
    void hold(double energy_j) noexcept TACTUS_NONBLOCKING;
    /// Replaces the energy of the last hold().
    void hold_instead(double energy_j) noexcept TACTUS_NONBLOCKING;
    /// Clears the observed energy: the spring's energy came from elsewhere.
    void forgive() noexcept { observed_energy_j_ = 0.0; }
    /// Clears the observed energy for a force that comes from no wall.
    void hold_nothing() noexcept TACTUS_NONBLOCKING;

    /// Work done on user and device since the start.
    [[nodiscard]] double work_j() const noexcept { return work_j_; }
    [[nodiscard]] double observed_energy_j() const noexcept { return observed_energy_j_; }

    /// Damping of the passivity controller, one period late: it would lose the observed energy in
    /// one period at this speed, within the device's limit. So the observed energy is bounded, not
    /// zero. N s/m; 0 at rest.
    [[nodiscard]] double damping_for(double speed_m_per_s) const noexcept TACTUS_NONBLOCKING;

private:
    double damping_n_s_per_m_;
    double friction_n_;
    double added_damping_max_n_s_per_m_;
    double period_s_;
    double work_j_{0.0};
    double held_j_{0.0};
    double observed_energy_j_{0.0};
    double unheld_j_{0.0}; ///< Observed energy before the last hold(), minus the energy held then.
};

} // namespace tactus
