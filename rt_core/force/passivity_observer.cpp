// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/passivity_observer.hpp"

#include "rt_core/base/assert.hpp"

#include <algorithm>

namespace tactus
{

void SentForces::send(const Vec3& force_n) noexcept
{
    for (std::uint32_t i = kForcesUnderWay - 1; i > 0; --i)
    {
        sent_[i] = sent_[i - 1];
    }
    sent_[0] = {force_n, 0.0};
}

/// Mean of the force at the device over 0 .. elapsed, on a time line in periods that starts when
/// the newest force was sent. Each force is at the device from its `begin` to its `end`:
///
///     -- sent[2] --|-- sent[1] --|------- sent[0] -------
///         0 <- mean over --------+----------> elapsed
///                                 delay
Vec3 SentForces::mean_since(std::uint32_t elapsed_periods) noexcept
{
    TACTUS_ASSERT(elapsed_periods > 0);
    const double elapsed = elapsed_periods;
    sent_[0].periods = elapsed;
    double begin = delay_;
    double end = elapsed;
    Vec3 sum(0.0, 0.0, 0.0);
    for (std::uint32_t i = 0; i < kForcesUnderWay; ++i)
    {
        const bool is_oldest = i + 1 == kForcesUnderWay;
        const double from = is_oldest ? 0.0 : std::max(begin, 0.0);
        sum += sent_[i].force_n * std::max(0.0, end - from);
        end = std::min(end, from);
        begin -= is_oldest ? 0.0 : sent_[i + 1].periods;
    }
    return sum / elapsed;
}

PassivityObserver::PassivityObserver(const DeviceLimits& device, double period_s) noexcept
    : damping_n_s_per_m_(device.damping_n_s_per_m)
    , friction_n_(device.friction_n)
    , added_damping_max_n_s_per_m_(device.added_damping_max_n_s_per_m)
    , period_s_(period_s)
{
}

void PassivityObserver::observe(const Vec3& force_n, const Vec3& displacement_m, double elapsed_s,
                                const Vec3& carried_m) noexcept
{
    TACTUS_ASSERT(elapsed_s > 0.0);
    const double work = force_n.dot(displacement_m);
    // Lower bound on the integral of b v^2 over the time, for any motion (Cauchy's inequality).
    const double viscous_loss = damping_n_s_per_m_ * displacement_m.squaredNorm() / elapsed_s;
    work_j_ += work;
    observed_energy_j_ +=
        work - force_n.dot(carried_m) - viscous_loss - friction_n_ * displacement_m.norm();
}

void PassivityObserver::hold(double energy_j) noexcept
{
    unheld_j_ = observed_energy_j_ - held_j_;
    hold_instead(energy_j);
}

void PassivityObserver::hold_instead(double energy_j) noexcept
{
    TACTUS_ASSERT(!(energy_j < 0.0));
    observed_energy_j_ = std::max(0.0, unheld_j_ + energy_j);
    held_j_ = energy_j;
}

void PassivityObserver::hold_nothing() noexcept
{
    held_j_ = 0.0;
    observed_energy_j_ = 0.0;
    unheld_j_ = 0.0;
}

double PassivityObserver::damping_for(double speed_m_per_s) const noexcept
{
    TACTUS_ASSERT(speed_m_per_s >= 0.0);
    const double lost_by_one = period_s_ * speed_m_per_s * speed_m_per_s;
    return observed_energy_j_ < lost_by_one * added_damping_max_n_s_per_m_
               ? observed_energy_j_ / lost_by_one
           : lost_by_one > 0.0 ? added_damping_max_n_s_per_m_
                               : 0.0;
}

} // namespace tactus
