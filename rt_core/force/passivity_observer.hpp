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

/// Forces on their way to a device that holds each force until the next one arrives,
/// DeviceLimits::delay_s after it was sent.
class SentForces
{
public:
    /// `delay_periods` is the device's delay in loop periods, whole or not.
    explicit SentForces(double delay_periods) noexcept : delay_(delay_periods) {}

    /// True if the delay is short enough for the forces that are kept.
    [[nodiscard]] bool knows_delay() const noexcept { return delay_ <= kForcesUnderWay - 1; }
    void send(const Vec3& force_n) noexcept TACTUS_NONBLOCKING;
    /// Replaces the force that was sent last.
    void replace_newest(const Vec3& force_n) noexcept { sent_[0].force_n = force_n; }
    /// Mean over time of the force at the device since the newest force was sent, `elapsed_periods`
    /// > 0 ago. Call it once before each send().
    [[nodiscard]] Vec3 mean_since(std::uint32_t elapsed_periods) noexcept TACTUS_NONBLOCKING;

private:
    struct Sent
    {
        Vec3 force_n{0.0, 0.0, 0.0};
        double periods{0.0}; ///< Number of periods until the next force was sent.
    };

    double delay_;
    std::array<Sent, kForcesUnderWay> sent_{}; ///< Sent forces, newest first.
};

/// Observes the energy at the port between force and device (time-domain passivity: Hannaford and
/// Ryu 2002), in contact and across contacts.
///
/// A held force F does exactly F . (x[k] - x[k-1]) of work, for any motion in between. A passive
/// wall gives back no more than the energy held in its spring. The observed energy E is the wall's
/// output beyond that, less the losses of the device by damping b and friction f:
///
///     E[k] = max(0, E[k-1] + work + held[k] - held[k-1] - b dx^2 / dt - f |dx|)
///
/// If an object moves, the work of its wall is F . (dx - the wall's displacement): the movers of
/// the object do the rest.
///
/// A sampled wall always generates some energy: K (v T)^2 / 2 on entry between two samples, and K
/// dx^2 / 2 in each period, which b dissipates again within stiffness_limit(). The controller
/// removes any further growth. E is at least 0, so that losses long ago hide no output, unlike in
/// the sum of Hannaford and Ryu.
///
/// Work and losses are of measured positions. A position that toggles between two quanta adds the
/// same square to output and loss, so no energy accumulates within the limit. Haptic thread.
class PassivityObserver
{
public:
    PassivityObserver(const DeviceLimits& device, double period_s) noexcept;

    /// Adds the work of a device displacement under `force_n`, the mean of the forces that the
    /// device held meanwhile. The work along `carried_m`, the displacement of a moving wall, does
    /// not count.
    /// - `elapsed_s` > 0.
    void observe(const Vec3& force_n, const Vec3& displacement_m, double elapsed_s,
                 const Vec3& carried_m = Vec3(0.0, 0.0, 0.0)) noexcept TACTUS_NONBLOCKING;
    /// Sets the energy held in the spring; called after observe().
    void hold(double energy_j) noexcept TACTUS_NONBLOCKING;
    /// Replaces the energy of the last hold().
    void hold_instead(double energy_j) noexcept TACTUS_NONBLOCKING;
    /// Clears the observed energy, as the change of the spring's energy was not the wall's.
    void forgive() noexcept { observed_energy_j_ = 0.0; }
    /// Clears observed and held energy, for a force that comes from no wall.
    void hold_nothing() noexcept TACTUS_NONBLOCKING;

    /// Work of the forces on user and device since the start.
    [[nodiscard]] double work_j() const noexcept { return work_j_; }
    [[nodiscard]] double observed_energy_j() const noexcept { return observed_energy_j_; }

    /// Damping of the passivity controller in N s/m, within the device's limit: at this speed it
    /// would dissipate the observed energy in one period. It acts one period late, so the observed
    /// energy is bounded, not zero. 0 at rest.
    [[nodiscard]] double damping_for(double speed_m_per_s) const noexcept TACTUS_NONBLOCKING;

private:
    double damping_n_s_per_m_;
    double friction_n_;
    double added_damping_max_n_s_per_m_;
    double period_s_;
    double work_j_{0.0};
    double held_j_{0.0};
    double observed_energy_j_{0.0};
    /// Observed energy before the last hold(), minus the energy that the spring held then.
    double unheld_j_{0.0};
};

} // namespace tactus
