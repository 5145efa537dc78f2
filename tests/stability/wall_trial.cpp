// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/stability/wall_trial.hpp"

#include "tests/shared/commanded_force.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace tactus::test
{

namespace
{

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

} // namespace

WallFigures run_wall_trial(const WallTrial& trial)
{
    return WallRun(trial).run();
}

std::function<double(double)> press(double from_m, double depth_m)
{
    return [=](double time_s)
    { return from_m - (from_m + depth_m) * std::clamp(time_s / 0.3, 0.0, 1.0); };
}

std::function<double(double)> tap(double from_m, double frequency_hz)
{
    return [=](double time_s)
    { return from_m * std::cos(2.0 * std::numbers::pi * frequency_hz * time_s); };
}

} // namespace tactus::test
