// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// The rules of docs/stability.md on the model of hand and device: allowed settings do not
/// oscillate and generate no more energy than stated; forbidden ones do. Prints the tables of that
/// page.

#include "platform/devices/simulated/device_classes.hpp"
#include "platform/devices/simulated/operator_and_device.hpp"
#include "platform/devices/simulated/operator_rotation.hpp"
#include "rt_core/force/force_conditioner.hpp"
#include "rt_core/force/force_pipeline.hpp"
#include "rt_core/force/stiffness_rule.hpp"
#include "rt_core/math/infinity.hpp"
#include "tests/shared/commanded_force.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace tactus::test
{
namespace
{

/// A hand presses a device into a wall that fills x < 0, or taps on it.
struct WallTrial
{
    DeviceLimits device;
    OperatorLimb hand;
    double period_s{1e-3};
    double stiffness_n_per_m{1'000.0};
    double surface_damping_n_s_per_m{0.0};
    std::uint32_t wall_delay_periods{0}; ///< Delay of the wall's own force, which makes it active.
    /// True if the wall's force is conditioned.
    bool is_conditioned{true};
    bool controls_passivity{true};
    /// True if a ForcePipeline at full gain follows the conditioner.
    bool is_piped{false};
    /// Stiffness that the wall reports to the conditioner; 0: the true one.
    double claimed_stiffness_n_per_m{0.0};
    double duration_s{2.0};
    Vec3 start_m{0.01, 0.0, 0.0};
    std::function<double(double time_s)> target_x_m; ///< Position that the hand aims at.
};

/// Measurements, of the true motion unless stated otherwise.
struct WallFigures
{
    double swing_m{0.0};       ///< Peak to peak in the last 0.5 s.
    double force_swing_n{0.0}; ///< Peak to peak of the force in the last 0.5 s.
    double deepest_m{0.0};     ///< Greatest depth in the wall.
    double work_j{0.0};        ///< Work of the motors by the simulation's own account.
    /// Greatest value of the work at any time: the energy that the wall generated.
    double largest_work_j{0.0};
    /// Greatest difference between the conditioner's work and the simulation's at the same time.
    double observer_error_j{0.0};
    double observed_energy_max_j{0.0};
    double damping_max_n_s_per_m{0.0};
    std::uint32_t held_periods{0}; ///< Periods in which ChangeLimit acted.
    std::uint32_t contacts{0};
    /// Greatest excess of a contact, from its first sample in the wall to its first outside: work
    /// of the motors minus the losses by the device's damping and friction, minus K (v T + q)^2 / 2
    /// and the quantisation's share (K q / 2 - f) x way if positive. docs/internals/passivity.md
    /// claims at most 0.
    double worst_excess_j{-1.0};
    double largest_contact_j{-1.0}; ///< Greatest work minus losses of a contact.
};

constexpr double kLast_s = 0.5;

/// Least and greatest of the values.
struct Span
{
    double low{std::numeric_limits<double>::infinity()};
    double high{-std::numeric_limits<double>::infinity()};

    void show(double value)
    {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    [[nodiscard]] double width() const { return high - low; }
};

/// Work and losses since a contact began.
struct ContactLedger
{
    bool is_open{false};
    double entry_m_per_s{0.0}; ///< Greatest speed around the first sample.
    double way_m{0.0};
    OperatorAndDeviceEnergy begin;
};

class WallRun
{
public:
    explicit WallRun(const WallTrial& trial)
        : trial_(trial)
        , sim_(OperatorAndDevice::create({trial.device, trial.hand, trial.period_s, trial.start_m})
                   .value())
        , conditioner_({trial.device, trial.period_s, 0.0, trial.controls_passivity})
        , pipeline_(pipeline_of(trial))
        , late_n_(trial.wall_delay_periods + 1, 0.0)
    {
        for (int i = 0; i < 1'000; ++i) // Runs until the gain is one.
        {
            static_cast<void>(piped(Vec3(0.0, 0.0, 0.0), sim_.measured_m(), 0.0));
        }
    }

    [[nodiscard]] WallFigures run()
    {
        const auto steps =
            static_cast<std::uint32_t>(std::lround(trial_.duration_s / trial_.period_s));
        for (std::uint32_t i = 0; i < steps; ++i)
        {
            const double time_s = i * trial_.period_s;
            const Vec3 measured = sim_.measured_m();
            watch_contact(measured.x());
            const Vec3 force = force_for(measured);
            const Vec3 before = sim_.position_m();
            speed_before_ = sim_.velocity_m_per_s().norm();
            sim_.step(force, Vec3(trial_.target_x_m(time_s), 0.0, 0.0));
            ledger_.way_m += (sim_.position_m() - before).norm();
            watch(time_s, force.x());
        }
        figures_.work_j = sim_.energy().force_work_j;
        figures_.swing_m = swing_.width();
        figures_.force_swing_n = force_swing_.width();
        return figures_;
    }

private:
    /// Spring and damper that only push, optionally with a delay of some periods.
    double wall_force(double x_m)
    {
        const double speed = (x_m - last_x_m_) / trial_.period_s;
        last_x_m_ = x_m;
        const double force = x_m < 0.0 ? std::max(0.0, -trial_.stiffness_n_per_m * x_m -
                                                           trial_.surface_damping_n_s_per_m * speed)
                                       : 0.0;
        std::shift_right(late_n_.begin(), late_n_.end(), 1);
        late_n_[0] = force;
        return late_n_.back();
    }

    Vec3 force_for(const Vec3& measured)
    {
        const Vec3 requested(wall_force(measured.x()), 0.0, 0.0);
        if (!trial_.is_conditioned)
        {
            return requested;
        }
        const double claimed = trial_.claimed_stiffness_n_per_m > 0.0
                                   ? trial_.claimed_stiffness_n_per_m
                                   : trial_.stiffness_n_per_m;
        const SpringForce out =
            trial_.is_piped ? piped(requested, measured, claimed)
                            : condition(conditioner_,
                                        {requested, measured, claimed, std::max(0.0, -measured.x()),
                                         1, std::abs(trial_.surface_damping_n_s_per_m)});
        figures_.held_periods += has_action(out.actions, ForceAction::change_limited) ? 1U : 0U;
        const double true_work_j = sim_.energy().force_work_j;
        figures_.observer_error_j =
            std::max(figures_.observer_error_j, std::abs(out.work_j - true_work_j));
        figures_.observed_energy_max_j =
            std::max(figures_.observed_energy_max_j, out.observed_energy_j);
        figures_.damping_max_n_s_per_m =
            std::max(figures_.damping_max_n_s_per_m, out.damping_n_s_per_m);
        return out.force_n;
    }

    static PipelineSetup pipeline_of(const WallTrial& trial)
    {
        PipelineSetup setup = pipeline_setup({}, trial.device, trial.period_s, 10.0);
        setup.conditioner.controls_passivity = trial.controls_passivity;
        setup.limits.damping_n_s_per_m = 0.0;
        return setup;
    }
    SpringForce piped(const Vec3& requested, const Vec3& measured, double stiffness)
    {
        ToolState tool;
        tool.position_m = measured;
        ToolOutput output;
        output.force_n = requested;
        output.proxy_m = Vec3(std::max(0.0, measured.x()), measured.y(), measured.z());
        output.stiffness_n_per_m = stiffness;
        output.in_contact = requested != Vec3(0.0, 0.0, 0.0);
        const double damping = std::abs(trial_.surface_damping_n_s_per_m);
        return pipeline_
            .step(tool, output, {}, {},
                  {.elapsed_s = trial_.period_s, .surface_damping_n_s_per_m = damping})
            .push;
    }

    void watch_contact(double measured_x_m)
    {
        const bool is_inside = measured_x_m < 0.0;
        if (is_inside && !ledger_.is_open)
        {
            ledger_ = {true, std::max(speed_before_, sim_.velocity_m_per_s().norm()), 0.0,
                       sim_.energy()};
        }
        else if (!is_inside && ledger_.is_open)
        {
            ledger_.is_open = false;
            close_contact();
        }
    }

    void close_contact()
    {
        const OperatorAndDeviceEnergy& end = sim_.energy();
        const double net = end.force_work_j - ledger_.begin.force_work_j -
                           (end.viscous_loss_j - ledger_.begin.viscous_loss_j) -
                           (end.friction_loss_j - ledger_.begin.friction_loss_j);
        const double q = trial_.device.quantum_m;
        const double entry_m = ledger_.entry_m_per_s * trial_.period_s + 0.5 * q;
        const double noise_n = 0.5 * trial_.stiffness_n_per_m * q - trial_.device.friction_n;
        const double allowed = 0.5 * trial_.stiffness_n_per_m * entry_m * entry_m +
                               std::max(0.0, noise_n) * ledger_.way_m;
        ++figures_.contacts;
        figures_.worst_excess_j = std::max(figures_.worst_excess_j, net - allowed);
        figures_.largest_contact_j = std::max(figures_.largest_contact_j, net);
    }

    void watch(double time_s, double force_n)
    {
        const double x = sim_.position_m().x();
        figures_.deepest_m = std::max(figures_.deepest_m, -x);
        figures_.largest_work_j = std::max(figures_.largest_work_j, sim_.energy().force_work_j);
        if (time_s >= trial_.duration_s - kLast_s)
        {
            swing_.show(x);
            force_swing_.show(force_n);
        }
    }

    WallTrial trial_;
    OperatorAndDevice sim_;
    ForceConditioner conditioner_;
    ForcePipeline pipeline_;
    std::vector<double> late_n_;
    double last_x_m_{0.0};
    double speed_before_{0.0};
    ContactLedger ledger_;
    Span swing_;
    Span force_swing_;
    WallFigures figures_;
};

WallFigures run_wall_trial(const WallTrial& trial)
{
    return WallRun(trial).run();
}

/// Target of a press: moves to `depth_m` behind the wall's surface within 0.3 s and stays there.
std::function<double(double)> press(double from_m, double depth_m)
{
    return [=](double time_s)
    { return from_m - (from_m + depth_m) * std::clamp(time_s / 0.3, 0.0, 1.0); };
}

/// Target of taps: oscillates between `from_m` and -`from_m` at this frequency.
std::function<double(double)> tap(double from_m, double frequency_hz)
{
    return [=](double time_s)
    { return from_m * std::cos(2.0 * std::numbers::pi * frequency_hz * time_s); };
}

struct Class
{
    const char* name;
    DeviceLimits device;
};

const std::array<Class, 3> kClasses{Class{"touch", kTouchClass}, Class{"omega", kOmegaClass},
                                    Class{"delta", kDeltaClass}};
constexpr std::array<double, 2> kPeriods_s{1e-3, 0.25e-3};
constexpr double kDepth_m = 0.01;

/// Finger without damping of its own that leans on a device without Coulomb friction: only b
/// prevents a limit cycle.
OperatorLimb worst_hand()
{
    return {0.0, 200.0, 0.0, 1e5, 0.0};
}

/// Trial at `share` of the predicted limit, ignoring the stiffness that the device's maker permits.
WallTrial pressed(const DeviceLimits& device, double period_s, double share, bool has_friction,
                  const OperatorLimb& hand)
{
    WallTrial trial;
    trial.device = device;
    trial.device.friction_n = has_friction ? device.friction_n : 0.0;
    trial.device.stiffness_max_n_per_m = 1e6;
    trial.hand = hand;
    trial.period_s = period_s;
    trial.stiffness_n_per_m = share * stiffness_limits(device, period_s).sampling_n_per_m;
    trial.is_conditioned = false;
    trial.duration_s = 30.0;
    trial.target_x_m = press(0.01, kDepth_m);
    return trial;
}

/// Bound of the limit cycle by quantisation: an oscillation of amplitude a at w = sqrt(K / m) gains
/// at most 4 a (K q / 2 - f) a cycle, and b - K T / 2 dissipates pi a^2 w. Peak to peak, plus one
/// quantum, in which nothing is visible.
double hum_bound_m(const WallTrial& trial)
{
    const double q = trial.device.quantum_m;
    const double noise_n =
        std::max(0.0, 0.5 * trial.stiffness_n_per_m * q - trial.device.friction_n);
    const double left =
        trial.device.damping_n_s_per_m -
        0.5 * trial.stiffness_n_per_m * (trial.period_s + 2.0 * trial.device.delay_s);
    const double w =
        std::sqrt(trial.stiffness_n_per_m / (trial.device.mass_kg + trial.hand.mass_kg));
    return q + 8.0 * noise_n / (std::numbers::pi * left * w);
}

/// Passive trial with taps, described by its parameters.
WallTrial random_taps(Random& random)
{
    const Class& one = kClasses[random.below(kClasses.size())];
    WallTrial trial;
    trial.device = one.device;
    trial.device.quantum_m *= random.between(0.0, 2.0);
    trial.device.friction_n *= random.one_in(3) ? 0.0 : random.between(0.2, 1.0);
    trial.device.stiffness_max_n_per_m = 1e6;
    trial.device.force_max_n = 100.0; // Clamped forces would hide the energy of the wall.
    trial.period_s = kPeriods_s[random.below(kPeriods_s.size())];
    trial.stiffness_n_per_m =
        random.between(0.3, 0.9) * stiffness_limits(trial.device, trial.period_s).sampling_n_per_m;
    trial.is_conditioned = false;
    trial.hand.mass_kg = random.between(0.0, 0.3);
    trial.hand.damping_n_s_per_m = random.between(0.0, 6.0);
    trial.start_m = Vec3(random.between(0.005, 0.02), 0, 0);
    trial.target_x_m = tap(trial.start_m.x(), random.between(1.0, 6.0));
    return trial;
}

} // namespace

TEST(Walls, rest_at_nine_tenths_of_the_limit_and_swing_well_above_it)
{
    std::printf("class rate Hz  K at 0.9   swing um / bound um   K at 2   swing um\n");
    for (const Class& one : kClasses)
    {
        for (const double period_s : kPeriods_s)
        {
            const WallTrial allowed = pressed(one.device, period_s, 0.9, false, worst_hand());
            const WallTrial wild = pressed(one.device, period_s, 2.0, false, worst_hand());
            const WallFigures calm = run_wall_trial(allowed);
            const WallFigures swings = run_wall_trial(wild);
            std::printf("%s %7.0f %9.0f %10.0f / %6.0f %10.0f %9.0f\n", one.name, 1.0 / period_s,
                        allowed.stiffness_n_per_m, 1e6 * calm.swing_m, 1e6 * hum_bound_m(allowed),
                        wild.stiffness_n_per_m, 1e6 * swings.swing_m);
            EXPECT_LT(calm.swing_m, hum_bound_m(allowed)) << one.name << " " << period_s;
            // The bound takes the worst of each rounding; some quanta remain.
            EXPECT_LT(calm.swing_m, 10.0 * one.device.quantum_m) << one.name << " " << period_s;
            EXPECT_GT(swings.swing_m, 4.0 * calm.swing_m) << one.name << " " << period_s;
            // The oscillation does not fade: the motors worked all the time.
            EXPECT_GT(swings.work_j, 0.02) << one.name << " " << period_s;
        }
    }
}

TEST(Walls, without_quantisation_rest_completely_at_nine_tenths)
{
    for (const Class& one : kClasses)
    {
        for (const double period_s : kPeriods_s)
        {
            WallTrial trial = pressed(one.device, period_s, 0.9, false, worst_hand());
            trial.device.quantum_m = 0.0;
            trial.duration_s = 60.0; // A tenth of b is left, so it rings for long.
            EXPECT_LT(run_wall_trial(trial).swing_m, 1e-6) << one.name << " " << period_s;
        }
    }
}

TEST(Walls, rest_within_a_quantum_when_the_device_has_its_friction_or_a_hand_its_damping)
{
    for (const Class& one : kClasses)
    {
        for (const double period_s : kPeriods_s)
        {
            const double cap = stiffness_limit(one.device, period_s);
            for (const bool has_friction : {true, false})
            {
                WallTrial trial = pressed(one.device, period_s, 0.9, has_friction,
                                          has_friction ? worst_hand() : OperatorLimb{});
                trial.stiffness_n_per_m = cap;
                const WallFigures figures = run_wall_trial(trial);
                std::printf("%s %7.0f Hz, cap %5.0f N/m, %s: swing %.2f um\n", one.name,
                            1.0 / period_s, cap,
                            has_friction ? "friction, no hand damping" : "hand, no friction",
                            1e6 * figures.swing_m);
                EXPECT_LE(figures.swing_m, one.device.quantum_m) << one.name << " " << period_s;
            }
        }
    }
}

TEST(Walls, of_3000_newtons_a_metre_rest_on_the_omega_class)
{
    for (const double period_s : kPeriods_s)
    {
        EXPECT_GE(stiffness_limit(kOmegaClass, period_s), 3'000.0);
        for (const bool is_conditioned : {false, true})
        {
            WallTrial trial = pressed(kOmegaClass, period_s, 0.9, true, OperatorLimb{});
            trial.device = kOmegaClass;
            trial.stiffness_n_per_m = 3'000.0;
            trial.is_conditioned = is_conditioned;
            trial.target_x_m = press(0.01, 0.03); // A force of 6 N.
            const WallFigures figures = run_wall_trial(trial);
            EXPECT_LE(figures.swing_m, kOmegaClass.quantum_m) << period_s;
            EXPECT_GT(figures.deepest_m, 0.5e-3);
            EXPECT_EQ(figures.damping_max_n_s_per_m, 0.0); // No damping is needed.
        }
    }
}

TEST(Walls, rest_with_surface_damping_and_delay_that_the_rule_knows)
{
    for (const double delay_periods : {0.35, 1.0, 1.5})
    {
        for (const double period_s : kPeriods_s)
        {
            DeviceLimits device = kOmegaClass;
            device.delay_s = delay_periods * period_s;
            WallTrial trial = pressed(device, period_s, 0.9, false, worst_hand());
            trial.device.quantum_m = 0.0;
            trial.duration_s = 8.0;
            trial.surface_damping_n_s_per_m = 0.4 * device.damping_n_s_per_m;
            trial.stiffness_n_per_m =
                stiffness_limit(trial.device, period_s, trial.surface_damping_n_s_per_m);
            EXPECT_LT(run_wall_trial(trial).swing_m, 1e-6) << delay_periods << " " << period_s;
            // The same wall with a rule that ignores the delay.
            trial.surface_damping_n_s_per_m = 0.0;
            trial.stiffness_n_per_m = 1.5 * stiffness_limit(kOmegaClass, period_s);
            EXPECT_GT(run_wall_trial(trial).swing_m, 5e-5) << delay_periods << " " << period_s;
        }
    }
}

TEST(Walls, make_no_more_energy_in_a_contact_than_they_may)
{
    Random random(1);
    std::uint32_t contacts = 0;
    double largest = 0.0;
    for (int i = 0; i < 60; ++i)
    {
        const WallFigures figures = run_wall_trial(random_taps(random));
        EXPECT_LE(figures.worst_excess_j, 1e-12) << "trial " << i;
        contacts += figures.contacts;
        largest = std::max(largest, figures.largest_contact_j);
    }
    std::printf("%u contacts, largest energy beyond the device's own losses %.3g J\n", contacts,
                largest);
    EXPECT_GT(contacts, 500U);
    EXPECT_GT(largest, 0.0);
}

TEST(Walls, that_are_too_stiff_make_more_energy_in_a_contact)
{
    Random random(1);
    double worst = -1.0;
    for (int i = 0; i < 20; ++i)
    {
        WallTrial trial = random_taps(random);
        trial.stiffness_n_per_m *= 4.0;
        worst = std::max(worst, run_wall_trial(trial).worst_excess_j);
    }
    EXPECT_GT(worst, 1e-6);
}

TEST(PassivityController, holds_the_energy_of_a_wall_that_comes_late)
{
    std::printf("class rate Hz, periods late: work J, swing um; with the controller\n");
    for (const Class& one : {kClasses[1], kClasses[2]})
    {
        for (const double period_s : kPeriods_s)
        {
            for (const std::uint32_t late : {1U, 2U, 3U})
            {
                WallTrial trial = pressed(one.device, period_s, 0.9, true,
                                          OperatorLimb{0.05, 200.0, 0.5, 2'000.0, 0.5});
                trial.is_conditioned = true;
                trial.wall_delay_periods = late;
                trial.controls_passivity = false;
                const WallFigures loose = run_wall_trial(trial);
                trial.controls_passivity = true;
                const WallFigures held = run_wall_trial(trial);
                trial.is_piped = true;
                const WallFigures piped = run_wall_trial(trial);
                std::printf(
                    "%s %5.0f, %u: %.2g J, %.0f um; %.2g J, %.0f um; piped %.2g J, %.0f um, "
                    "%u periods\n",
                    one.name, 1.0 / period_s, late, loose.largest_work_j, 1e6 * loose.swing_m,
                    held.largest_work_j, 1e6 * held.swing_m, piped.largest_work_j,
                    1e6 * piped.swing_m, piped.held_periods);
                EXPECT_LT(piped.largest_work_j, 2.5e-3) << one.name << " " << late;
                EXPECT_LT(piped.swing_m, one.device.quantum_m) << one.name << " " << late;
                // The wall may store at most one spring at the hand's deepest rest.
                EXPECT_LT(held.largest_work_j, 2.5e-3) << one.name << " " << late;
                EXPECT_LT(held.swing_m, one.device.quantum_m) << one.name << " " << late;
                EXPECT_LE(held.damping_max_n_s_per_m, one.device.added_damping_max_n_s_per_m);
                if (late == 3)
                {
                    EXPECT_GT(loose.largest_work_j, 40.0 * held.largest_work_j) << one.name;
                    EXPECT_GT(loose.swing_m, 1e-3) << one.name;
                }
            }
        }
    }
}

TEST(PassivityController, holds_the_energy_of_a_wall_that_is_stiffer_than_it_says)
{
    for (const double period_s : kPeriods_s)
    {
        for (const double times : {2.0, 3.0})
        {
            WallTrial trial = pressed(kOmegaClass, period_s, 0.9, false, worst_hand());
            trial.is_conditioned = true;
            trial.duration_s = 10.0;
            trial.claimed_stiffness_n_per_m = trial.stiffness_n_per_m;
            trial.stiffness_n_per_m *= times;
            trial.controls_passivity = false;
            const WallFigures loose = run_wall_trial(trial);
            trial.controls_passivity = true;
            const WallFigures held = run_wall_trial(trial);
            std::printf("omega %5.0f Hz, %.0f times: %.2g J, %.0f um; %.2g J, %.0f um\n",
                        1.0 / period_s, times, loose.largest_work_j, 1e6 * loose.swing_m,
                        held.largest_work_j, 1e6 * held.swing_m);
            EXPECT_GT(loose.swing_m, 5e-4) << period_s << " " << times;
            EXPECT_LT(held.swing_m, loose.swing_m / 10.0) << period_s << " " << times;
            EXPECT_LT(held.largest_work_j, loose.largest_work_j / 10.0) << period_s;
        }
    }
}

TEST(PassivityObserver, counts_the_energy_of_the_continuous_motion)
{
    for (const double delay_periods : {0.0, 1.0, 3.0})
    {
        for (const std::uint32_t late : {0U, 2U})
        {
            WallTrial trial = pressed(kOmegaClass, 1e-3, 0.9, true, OperatorLimb{});
            trial.device.quantum_m = 0.0;
            trial.device.delay_s = delay_periods * 1e-3;
            trial.is_conditioned = true;
            trial.wall_delay_periods = late;
            trial.target_x_m = tap(0.01, 4.0);
            const WallFigures figures = run_wall_trial(trial);
            EXPECT_GT(std::abs(figures.work_j), 1e-5);
            EXPECT_LT(figures.observer_error_j, 1e-12) << delay_periods << " " << late;
        }
    }
}

TEST(PassivityObserver, is_off_by_no_more_than_the_quantum_explains)
{
    WallTrial trial = pressed(kOmegaClass, 1e-3, 0.9, true, OperatorLimb{});
    trial.is_conditioned = true;
    trial.target_x_m = tap(0.01, 4.0);
    const WallFigures figures = run_wall_trial(trial);
    // Summation by parts: half a quantum for each newton of change of the force, eight contacts.
    const double force_way_n = 2.0 * 12.0 * (figures.contacts + 1.0);
    EXPECT_LT(figures.observer_error_j, 0.5 * kOmegaClass.quantum_m * force_way_n);
    EXPECT_GT(figures.observer_error_j, 0.0);
}

TEST(DeviceClasses, have_the_caps_of_the_page)
{
    std::printf("class: sampling / quantisation / device -> cap, N/m\n");
    for (const Class& one : kClasses)
    {
        ASSERT_EQ(find_fault(one.device), nullptr) << one.name;
        for (const double period_s : kPeriods_s)
        {
            const StiffnessLimits limits = stiffness_limits(one.device, period_s);
            std::printf("%s %5.0f Hz: %.0f / %.0f / %.0f -> %.0f\n", one.name, 1.0 / period_s,
                        limits.sampling_n_per_m, limits.quantisation_n_per_m, limits.device_n_per_m,
                        limits.limit_n_per_m);
        }
    }
    EXPECT_DOUBLE_EQ(stiffness_limit(kTouchClass, 1e-3), 400.0);
    EXPECT_DOUBLE_EQ(stiffness_limit(kTouchClass, 0.25e-3), 400.0);
    EXPECT_DOUBLE_EQ(stiffness_limit(kOmegaClass, 1e-3), 3'060.0);
    EXPECT_DOUBLE_EQ(stiffness_limit(kOmegaClass, 0.25e-3), 5'000.0);
    EXPECT_DOUBLE_EQ(stiffness_limit(kDeltaClass, 1e-3), 3'060.0);
    EXPECT_DOUBLE_EQ(stiffness_limit(kDeltaClass, 0.25e-3), 5'000.0);
}

namespace
{

/// A wrist rotates a device about an axis into a wall that begins at the angle 0.
struct TurningTrial
{
    DeviceLimits device{kDeskClass};
    OperatorLimb wrist{.mass_kg = 0.0,
                       .stiffness_n_per_m = 0.2,
                       .damping_n_s_per_m = 0.0,
                       .grip_stiffness_n_per_m = 100.0,
                       .grip_damping_n_s_per_m = 0.0};
    double stiffness_nm_per_rad{1.0};
    std::size_t late_periods{0}; ///< Delay of the wall's own torque, which makes it active.
    bool controls_passivity{false};
    double duration_s{30.0};
};

struct TurningFigures
{
    double swing_rad{0.0}; ///< Peak to peak in the last 0.5 s.
    double largest_work_j{0.0};
    double observer_error_j{0.0}; ///< Difference from the simulation's own energy.
    double off_axis_nm{0.0};
};

TurningFigures turn_into_wall(const TurningTrial& trial)
{
    const Vec3 axis = Vec3(2.0, -1.0, 2.0) / 3.0;
    auto sim = std::move(OperatorRotation::create({trial.device.rotation, trial.device.delay_s,
                                                   trial.wrist, 1e-3, Mat3::Identity()}))
                   .value();
    ConditionerSetup setup;
    setup.device = trial.device;
    setup.controls_passivity = trial.controls_passivity;
    WrenchConditioner conditioner(setup);
    const std::function<double(double)> wanted_rad = press(0.1, 0.1);
    std::vector<double> late_nm(trial.late_periods + 1, 0.0);
    TurningFigures figures;
    double least_rad = kInfinity;
    double most_rad = -kInfinity;
    Vec3 turned(0.0, 0.0, 0.0);
    Mat3 last = Mat3::Identity();
    const auto steps = static_cast<int>(std::lround(trial.duration_s * 1e3));
    for (int i = 0; i < steps; ++i)
    {
        const Mat3 measured = to_rotation(sim.measured());
        turned += rotation_vector(orthonormalised(measured * last.transpose()));
        last = measured;
        const double angle = turned.dot(axis) + 0.1; // The start is 0.1 in front of the wall.
        std::shift_right(late_nm.begin(), late_nm.end(), 1);
        late_nm[0] = angle < 0.0 ? -trial.stiffness_nm_per_rad * angle : 0.0;
        const ToolForce out = condition(
            conditioner, {{}, {late_nm.back() * axis, turned, trial.stiffness_nm_per_rad, 0.0, 1}});
        figures.observer_error_j = std::max(
            figures.observer_error_j, std::abs(out.torque.work_j - sim.energy().force_work_j));
        figures.off_axis_nm = std::max(figures.off_axis_nm, out.torque.force_n.cross(axis).norm());
        const double target = wanted_rad(i * 1e-3) - 0.1;
        sim.step(out.torque.force_n, Eigen::AngleAxisd(target, axis).toRotationMatrix());
        figures.largest_work_j = std::max(figures.largest_work_j, sim.energy().force_work_j);
        if (i >= steps - 500)
        {
            least_rad = std::min(least_rad, angle);
            most_rad = std::max(most_rad, angle);
        }
    }
    figures.swing_rad = most_rad - least_rad;
    return figures;
}

/// Trial at `share` of the rule's limit, ignoring the maker's.
TurningTrial turned_into(double share)
{
    TurningTrial trial;
    trial.device.rotation.stiffness_max_nm_per_rad = 1e3;
    trial.stiffness_nm_per_rad =
        share * stiffness_limits(rotational_limits_of(trial.device), 1e-3).sampling_n_per_m;
    return trial;
}

} // namespace

TEST(TurningWalls, rest_at_nine_tenths_of_the_limit)
{
    const TurningFigures rests = turn_into_wall(turned_into(0.9));
    std::printf(
        "turning: swing at 0.9 of the limit %.3g rad, work %.3g J, observer off by %.2g J\n",
        rests.swing_rad, rests.largest_work_j, rests.observer_error_j);
    EXPECT_LT(rests.swing_rad, 1e-3);
    EXPECT_LT(rests.largest_work_j, 1e-3);
    EXPECT_LT(rests.observer_error_j, 1e-6) << "the ledgers agree";
    EXPECT_LT(rests.off_axis_nm, 1e-9);
}

/// A wall above the rule's limit is scaled down to it, so an active one shows what the controller
/// limits.
TEST(TurningWalls, that_come_late_are_held_by_the_passivity_controller)
{
    TurningTrial trial = turned_into(0.9);
    trial.late_periods = 3;
    const TurningFigures without = turn_into_wall(trial);
    trial.controls_passivity = true;
    const TurningFigures with = turn_into_wall(trial);
    std::printf("turning, 3 periods late: %.3g J and %.3g rad without, %.3g J and %.3g rad with\n",
                without.largest_work_j, without.swing_rad, with.largest_work_j, with.swing_rad);
    EXPECT_GT(without.largest_work_j, 20.0 * with.largest_work_j);
    EXPECT_GT(without.swing_rad, 10.0 * with.swing_rad);
}

TEST(TurningWalls, that_are_too_stiff_are_scaled_down_with_their_force)
{
    WrenchConditioner sut({.device = kDeskClass});
    const double cap = stiffness_limit(rotational_limits_of(kDeskClass), 1e-3);
    const ToolForce out = condition(sut, {{Vec3(0.0, 0.0, 4.0), {}, 100.0, 0.0, 1},
                                          {Vec3(0.1, 0.0, 0.0), {}, 2.0 * cap, 0.0, 1}});
    EXPECT_NEAR(out.torque.force_n.x(), 0.05, 1e-12);
    EXPECT_NEAR(out.push.force_n.z(), 2.0, 1e-12);
}

} // namespace tactus::test
