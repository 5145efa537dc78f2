// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/device_force.hpp"
#include "platform/devices/simulated/faulty_device.hpp"
#include "platform/devices/simulated/simulated_device.hpp"
#include "platform/devices/simulated/simulated_periodic_timer.hpp"
#include "platform/loop/haptic_loop.hpp"
#include "platform/loop/model_marks.hpp"
#include "platform/loop/refinement_state_tap.hpp"
#include "platform/loop/scene_mailbox.hpp"
#include "platform/loop/telemetry_tap.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/unit/hrtc/period.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

/// Haptic loop on a simulated device whose hand presses on a model, in virtual time.
namespace tactus::hrtc::test
{

/// FrameSetup::pose_age_max_ns.
inline constexpr Duration kPoseAge = milliseconds(100);
/// Depth for 1.7 N; without a force the hand sinks until the spring makes 6 of 8 N.
inline constexpr double kPress_m = 0.012;
/// Start height of the hand, relative to the model's diagonal.
inline constexpr double kStartHeight = 0.05;
/// Frame from which the hand rests in the surface with the full force.
inline constexpr std::uint64_t kSettled = 1'000;
/// Change of the pressed force between frames without disturbance.
inline constexpr double kOwnStep_n = 0.02;
inline constexpr double kRounding_n = 1e-9;
/// Change while the force returns, with that of the frame's own force.
inline constexpr double kBackStep_n = 2.0 * 8.0 * kPeriod_s / kRiseTime_s + kOwnStep_n;

/// Hand that descends on a place of the surface along its normal, presses and stays.
struct PressingOperator final : OperatorMotion
{
    PressingOperator(const Vec3& place_m, const Vec3& outward, double height_m, double press_m)
        : place_m_(place_m), outward_(outward), height_m_(height_m), press_m_(press_m)
    {
    }
    [[nodiscard]] Vec3 start_world_m() const noexcept override
    {
        return place_m_ + height_m_ * outward_;
    }
    [[nodiscard]] Vec3 next_world_m(const OperatorSense& sense) noexcept override
    {
        const double done = std::min(static_cast<double>(sense.frame) / 500.0, 1.0);
        return place_m_ + (height_m_ - done * (height_m_ + press_m_)) * outward_;
    }

private:
    Vec3 place_m_;
    Vec3 outward_;
    double height_m_;
    double press_m_;
};

/// Device whose readings a test can change; keeps the written forces.
struct TamperedDevice final : HapticDevice
{
    using Tamper = std::function<void(std::uint64_t frame, DeviceSample& sample)>;

    TamperedDevice(std::unique_ptr<SimulatedDevice> device, std::vector<DeviceFault> faults,
                   Tamper tamper)
        : simulated_(*device)
        , device_(std::make_unique<FaultyDevice>(std::move(device), std::move(faults)))
        , tamper_(std::move(tamper))
    {
    }
    [[nodiscard]] const DeviceInfo& info() const noexcept override { return device_->info(); }
    [[nodiscard]] DeviceSample read() noexcept override
    {
        DeviceSample sample = device_->read();
        tamper_(reads_++, sample);
        return sample;
    }
    void write(const Wrench& wrench) noexcept override
    {
        device_->write(wrench);
        written_n.push_back(to_vec3(wrench.force_world_n));
        written_nm.push_back(to_vec3(wrench.torque_world_nm));
    }
    void brake() noexcept override { device_->brake(); }
    void brake_softly() noexcept override { device_->brake_softly(); }
    void release_brake() noexcept override
    {
        before_release();
        device_->release_brake();
    }
    [[nodiscard]] DeviceStatus status() const noexcept override { return device_->status(); }

    [[nodiscard]] Vec3 felt_n() const noexcept { return simulated_.felt_force_world_n(); }

    std::vector<Vec3> written_n; ///< Forces, one for each frame; the last is the zero at the end.
    std::vector<Vec3> written_nm;
    std::function<void()> before_release = [] {};

private:
    const SimulatedDevice& simulated_;
    std::unique_ptr<HapticDevice> device_;
    Tamper tamper_;
    std::uint64_t reads_{0};
};

struct LoopRig;

struct LoopRigOptions
{
    TamperedDevice::Tamper tamper = [](std::uint64_t, DeviceSample&) {};
    /// Called while a frame's device is read.
    std::function<void(LoopRig& rig, std::uint64_t frame)> meanwhile{};
    std::vector<DeviceFault> faults{};
    std::vector<LateWake> late_wakes{};
    std::optional<Duration> watchdog{};
    bool static_model{false};
    bool has_mailbox{false};                ///< True if objects have the poses of mailbox().
    double object_speed_m_per_s{kInfinity}; ///< Object speed limit.
    /// Object speed limit of the last force stage; empty: that of the mailbox.
    std::optional<double> change_speed_m_per_s{};
    DeviceLimits device{kDeskClass};
    double press_m{kPress_m}; ///< Depth; negative: the hand rests above the surface.
    std::uint64_t frames{2'000};
    double speed_max_m_per_s{10.0};
    double stiffness_n_per_m{500.0};
    ToolCore core{PointCore{}};
    double angular_stiffness_nm_per_rad{0.0}; ///< See ToolSpec.
    const Clock* clock{nullptr}; ///< Another clock than the virtual one, with its own timer.
    PeriodicTimer* timer{nullptr};
    std::optional<std::size_t> front_slots{}; ///< Slots of the viewer copy.
    bool is_coarse{false};                    ///< True if only the base mesh is loaded.
    /// Distance of an object of a second model beyond the hand's start.
    std::optional<double> neighbour_m{};
};

struct LoopRig
{
    explicit LoopRig(LoopRigOptions options)
        : options_(std::move(options))
        , model_(tactus::test::small_model(0))
        , frames_(rig_models(options_), rig_options(options_))
        , timer_(clock_, options_.late_wakes)
        , statistics_(1, objects(options_), objects(options_), kPeriod)
    {
        if (!options_.is_coarse)
        {
            load_everything(frames_);
        }
        make_device();
        const DeviceLimits& device_limits = device().info().limits;
        tool().limits = {
            options_.speed_max_m_per_s, device_limits.force_max_n, options_.stiffness_n_per_m,
            kDampingShare * device_limits.damping_n_s_per_m, device_limits.rotation.torque_max_nm};
        tool().limits.rotation_max_rad_per_s = kRotationMax_rad_per_s;
        tool().spec = frames_.frame().tool(0).spec();
        tool().conditioner.device = device_limits;
        tool().conditioner.period_s = kPeriod_s;
        tool().change.object_speed_max_m_per_s =
            options_.change_speed_m_per_s.value_or(options_.object_speed_m_per_s);
        LoopParts parts;
        parts.frame = &frames_.frame();
        parts.tools = tools_;
        parts.timer = options_.timer != nullptr ? options_.timer : &timer_;
        parts.clock = &clock();
        parts.frames = options_.frames;
        parts.servers_gone = &servers_gone;
        parts.starved = &starved;
        mailbox_.emplace(std::vector{placed()}, 1, kPoseAge, options_.object_speed_m_per_s);
        parts.scene_mailbox = options_.has_mailbox ? &*mailbox_ : nullptr;
        parts.telemetry = &telemetry;
        if (options_.front_slots)
        {
            front_.emplace(frame().pools().cache.pages, *options_.front_slots);
            parts.refinement_state = &*front_;
        }
        parts.budgets.splits = kMaxSplitsPerFrame;
        loop_.emplace(parts, statistics_);
        static_cast<void>(parts.timer->start(kPeriod, {}));
    }

    void run() { loop_->run(); }

    [[nodiscard]] SceneMailbox& mailbox() { return *mailbox_; }
    /// Initial pose of the object.
    [[nodiscard]] ObjectPose placed() const
    {
        ObjectPose pose;
        pose.translation_m = -frames_.frame().model({0}).header.origin_m();
        return pose;
    }
    [[nodiscard]] const RunStatistics& statistics() const { return statistics_; }
    [[nodiscard]] HapticLoop& loop() { return *loop_; }
    [[nodiscard]] Frame& frame() { return frames_.frame(); }
    [[nodiscard]] RefinementStateTap& front() { return *front_; }
    [[nodiscard]] TamperedDevice& device() { return static_cast<TamperedDevice&>(*tool().device); }
    [[nodiscard]] std::span<const ToolSetup> tools() const { return tools_; }
    [[nodiscard]] SimulatedClock& virtual_clock() { return clock_; }
    [[nodiscard]] const Clock& clock() const
    {
        return options_.clock != nullptr ? *options_.clock : clock_;
    }
    [[nodiscard]] const Vec3& written_n(std::uint64_t frame) { return device().written_n[frame]; }
    [[nodiscard]] const Vec3& written_nm(std::uint64_t frame) { return device().written_nm[frame]; }

    /// Events of the loop, in order; the log is empty afterwards.
    [[nodiscard]] std::vector<SafetyEvent> events()
    {
        std::vector<SafetyEvent> events;
        loop_->safety_log().take_into(events);
        return events;
    }

    /// True if an event has the cause.
    [[nodiscard]] static bool has(const std::vector<SafetyEvent>& events, ForceOff cause)
    {
        return std::ranges::any_of(events, [cause](const SafetyEvent& event)
                                   { return has_cause(event.causes, cause); });
    }

    [[nodiscard]] std::uint64_t frames_with(ForceAction action) const
    {
        const auto bit = std::countr_zero(static_cast<std::uint8_t>(action));
        return statistics_.tools.front().conditioned[static_cast<std::size_t>(bit)];
    }

    /// Greatest change of the force between these frames.
    [[nodiscard]] double largest_step_n(std::uint64_t from, std::uint64_t to)
    {
        return largest_step(device().written_n, from, to);
    }
    [[nodiscard]] double largest_step_nm(std::uint64_t from, std::uint64_t to)
    {
        return largest_step(device().written_nm, from, to);
    }

    static double largest_step(const std::vector<Vec3>& written, std::uint64_t from,
                               std::uint64_t to)
    {
        double most = 0.0;
        for (std::uint64_t i = from; i < to; ++i)
        {
            most = std::max(most, (written[i + 1] - written[i]).norm());
        }
        return most;
    }

    ModelMarks servers_gone;
    ModelMarks starved;
    TelemetryTap telemetry{kPeriod};

private:
    static std::size_t objects(const LoopRigOptions& options)
    {
        return options.neighbour_m ? 2 : 1;
    }
    static std::vector<const tactus::test::TestModel*> rig_models(const LoopRigOptions& options)
    {
        std::vector models{&tactus::test::small_model(0), &tactus::test::small_model(1)};
        models.resize(objects(options));
        return models;
    }
    /// Least and greatest x of a model's vertices.
    static std::pair<double, double> span_x(const tactus::test::TestModel& model)
    {
        double least = kInfinity;
        double most = -kInfinity;
        for (const tactus::test::Face& face : model.faces)
        {
            for (const Vec3f& corner : face)
            {
                least = std::min(least, static_cast<double>(corner[0]));
                most = std::max(most, static_cast<double>(corner[0]));
            }
        }
        return {least, most};
    }
    static tactus::test::RigOptions rig_options(const LoopRigOptions& options)
    {
        tactus::test::RigOptions rig = tactus::test::with_room_for_all();
        rig.static_when_it_fits = options.static_model;
        rig.tools = {{0.01 * tactus::test::small_model(0).diagonal_m, options.stiffness_n_per_m,
                      8.0, 1.0, options.core}};
        rig.tools.front().angular_stiffness_nm_per_rad = options.angular_stiffness_nm_per_rad;
        if (options.neighbour_m)
        {
            const double start_m = span_x(tactus::test::small_model(0)).second +
                                   kStartHeight * tactus::test::small_model(0).diagonal_m;
            rig.objects = {{ModelId{0}}, {ModelId{1}}};
            rig.poses.resize(2);
            rig.poses[1].translation_m.x() =
                start_m + *options.neighbour_m - span_x(tactus::test::small_model(1)).first;
        }
        return rig;
    }

    /// Places the hand above the face that is farthest out in x.
    void make_device()
    {
        const auto middle = [](const tactus::test::Face& face)
        { return Vec3((to_vec3(face[0]) + to_vec3(face[1]) + to_vec3(face[2])) / 3.0); };
        const Vec3 place = middle(*std::ranges::max_element(
            model_.faces, {}, [&](const auto& face) { return middle(face).x(); }));
        SimulatedDeviceOptions device;
        device.clock = &clock();
        device.device = options_.device;
        device.watchdog = options_.watchdog;
        device.workspace_centre_world_m = place;
        auto hand = std::make_unique<PressingOperator>(
            place, Vec3::UnitX(), kStartHeight * model_.diagonal_m, options_.press_m);
        tool().device = std::make_unique<TamperedDevice>(
            std::move(SimulatedDevice::create(device, std::move(hand))).value(), options_.faults,
            [this](std::uint64_t frame, DeviceSample& sample)
            {
                if (options_.meanwhile)
                {
                    options_.meanwhile(*this, frame);
                }
                options_.tamper(frame, sample);
            });
    }
    [[nodiscard]] ToolSetup& tool() { return tools_.front(); }

    LoopRigOptions options_;
    const tactus::test::TestModel& model_;
    tactus::test::FrameRig frames_;
    SimulatedClock clock_{MonotonicTime{1'000'000'000}};
    SimulatedPeriodicTimer timer_;
    RunStatistics statistics_;
    std::array<ToolSetup, 1> tools_;
    std::optional<SceneMailbox> mailbox_;
    std::optional<RefinementStateTap> front_;
    std::optional<HapticLoop> loop_;
};

} // namespace tactus::hrtc::test
