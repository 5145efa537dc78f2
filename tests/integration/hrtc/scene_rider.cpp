// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// scene_rider: simulated operator that flies through a server's scene at one speed and touches
/// object after object. The controller is hrtc's with its own loop: the hand has the given speed or
/// less under any load. Prints as JSON how often it was blocked by a model that was not resident:
/// because it was requested too late, or because the machine delivered it late.

#include "platform/choices/run_options.hpp"
#include "platform/controller/controller.hpp"
#include "platform/program/command_line.hpp"
#include "platform/program/run_program.hpp"
#include "platform/scene/scene_choice.hpp"
#include "rt_core/frame/frame.hpp"
#include "transport/chunk_loader.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/dds/scene_reader.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace tactus::hrtc
{
namespace
{

using Clock = std::chrono::steady_clock;

constexpr double kPeriod_s = 1e-3;
constexpr auto kPeriod = std::chrono::milliseconds(1);
/// Height of the hand above an object's sphere before it moves to the next one.
constexpr double kRise_m = 0.3;
/// Frames on each object until a force is rendered, since chunks follow the base mesh; at most the
/// second number.
constexpr int kRestFrames = 20;
constexpr int kRestFramesMost = 60'000;
/// A base mesh is requested 150 ms before the hand arrives. A delivery that takes longer than this
/// is the machine's delay.
constexpr double kInTime_ms = 70.0;

struct Arguments
{
    std::string scene;
    std::uint32_t domain{0};
    double pool_mib{2.0};
    double speed_m_per_s{2.0};
    std::uint32_t visits{20};
};

double ms_since(Clock::time_point begin)
{
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

struct Figures
{
    std::uint64_t frames{0};
    /// Frames with a wall for which only the program is responsible.
    std::uint64_t invisible_wall_frames{0};
    std::uint64_t latency_miss_frames{0}; ///< Frames with a hand blocked by the machine's delay.
    std::uint32_t visits{0};
    std::uint32_t touched{0}; ///< Objects with an exact answer in contact.
    std::uint32_t came{0};    ///< Models that became resident.
    std::uint32_t went{0};
    std::uint32_t here_max{0};
    double came_ms_max{0.0}; ///< Longest time from request to residence, by the wall clock.
    double late_ms_max{0.0}; ///< Longest frame.
};

class Ride
{
public:
    Ride(Controller& controller, double speed_m_per_s)
        : controller_(controller)
        , step_m_(speed_m_per_s * kPeriod_s)
        , stages_(controller.models().size(), ModelStage::known)
        , wanted_(controller.models().size())
        , due_(Clock::now())
        , last_(due_)
    {
        states_.resize(controller.tools().size());
        place_ = above(0);
    }

    /// Descends on the object at full speed, rests, rises, and moves to the next one.
    void visit(std::uint32_t object)
    {
        is_touched_ = false;
        go_to(above(object));
        go_to(inside(object));
        for (int i = 0; i < kRestFrames || (!is_touched_ && i < kRestFramesMost); ++i)
        {
            frame();
        }
        go_to(above(object));
        ++figures_.visits;
        figures_.touched += is_touched_ ? 1 : 0;
    }
    [[nodiscard]] const Figures& figures() const { return figures_; }

private:
    struct Sphere
    {
        Vec3 centre_m;
        double radius_m;
    };

    /// Sphere around the model's box, in the world.
    [[nodiscard]] Sphere sphere_of(std::uint32_t object) const
    {
        const ModelId model = controller_.objects()[object].model;
        const ModelHeader header =
            ModelHeader::parse(controller_.models()[model.value].header).value();
        const ObjectPose pose = model_pose(controller_.poses()[object], header.origin_m());
        const auto& extent = header.fields().extent_quanta;
        const Vec3 middle =
            0.5 * static_cast<double>(header.quantum_m()) * Vec3(extent[0], extent[1], extent[2]);
        return {to_world(pose, middle), pose.scale * middle.norm()};
    }
    [[nodiscard]] Vec3 above(std::uint32_t object) const
    {
        const Sphere sphere = sphere_of(object);
        return sphere.centre_m + Vec3(0.0, 0.0, sphere.radius_m + kRise_m);
    }
    /// Place well below the surface of any round object.
    [[nodiscard]] Vec3 inside(std::uint32_t object) const
    {
        const Sphere sphere = sphere_of(object);
        return sphere.centre_m + Vec3(0.0, 0.0, 0.3 * sphere.radius_m);
    }

    void go_to(const Vec3& goal)
    {
        for (double left_m = (goal - place_).norm(); left_m > 0.0; left_m = (goal - place_).norm())
        {
            place_ = left_m > step_m_ ? Vec3(place_ + step_m_ / left_m * (goal - place_)) : goal;
            frame();
        }
    }

    /// Runs a frame at least a period after the last one, so that the hand is never faster.
    void frame()
    {
        due_ = std::max(due_ + kPeriod, Clock::now());
        std::this_thread::sleep_until(due_);
        const auto now = Clock::now();
        figures_.late_ms_max = std::max(
            figures_.late_ms_max, std::chrono::duration<double, std::milli>(now - last_).count());
        last_ = now;
        const std::int64_t now_ns =
            std::chrono::duration_cast<std::chrono::nanoseconds>(now.time_since_epoch()).count();
        controller_.chunk_loader().step(now_ns);
        for (ToolState& state : states_)
        {
            state.position_m = place_;
            state.sample_time_ns = now_ns;
        }
        judge(controller_.frame().run({states_, {}, controller_.budgets(), now_ns}), now);
    }

    void judge(const FrameOutput& output, Clock::time_point now)
    {
        ++figures_.frames;
        is_touched_ =
            is_touched_ || (output.tools[0].in_contact &&
                            std::ranges::any_of(output.pairs, [](const PairOutput& pair)
                                                { return pair.kind == AnswerKind::exact; }));
        std::uint32_t here = 0;
        bool is_latency_miss = false;
        for (std::size_t i = 0; i < stages_.size(); ++i)
        {
            const ModelStage stage = output.models[i].stage;
            here += stage != ModelStage::known ? 1 : 0;
            is_latency_miss = is_latency_miss || (is_awaited(stages_[i]) && is_awaited(stage) &&
                                                  ms_since(wanted_[i]) > kInTime_ms);
            if (stage == stages_[i])
            {
                continue;
            }
            if (stages_[i] == ModelStage::known)
            {
                wanted_[i] = now;
            }
            if (stage == ModelStage::resident)
            {
                ++figures_.came;
                figures_.came_ms_max = std::max(figures_.came_ms_max, ms_since(wanted_[i]));
            }
            figures_.went += stage == ModelStage::leaving ? 1 : 0;
            stages_[i] = stage;
        }
        figures_.here_max = std::max(figures_.here_max, here);
        if (output.scene.walled_tools > 0)
        {
            ++(is_latency_miss ? figures_.latency_miss_frames : figures_.invisible_wall_frames);
        }
    }
    static bool is_awaited(ModelStage stage)
    {
        return stage == ModelStage::wanted || stage == ModelStage::arriving;
    }

    Controller& controller_;
    double step_m_;
    std::vector<ModelStage> stages_;
    std::vector<Clock::time_point> wanted_; ///< Times of the requests, by model.
    std::vector<ToolState> states_;
    Vec3 place_{0.0, 0.0, 0.0};
    Clock::time_point due_;
    Clock::time_point last_;
    bool is_touched_{false};
    Figures figures_;
};

int run(int argc, char** argv)
{
    CommandLine line("scene_rider", "Flies through a server's scene and tells what held it up.");
    Arguments arguments;
    line.add_option("--scene", arguments.scene, "Its name").required();
    line.add_option("--domain", arguments.domain, "DDS domain id").integer_between(0, 232);
    line.add_option("--pool-mib", arguments.pool_mib, "As hrtc's").number_between(0.1, 4'096.0);
    line.add_option("--speed", arguments.speed_m_per_s, "Of the hand, in m/s")
        .number_between(0.01, 10.0);
    line.add_option("--visits", arguments.visits, "How many objects to touch");
    if (const std::optional<int> code = line.parse(argc, argv))
    {
        return *code;
    }
    const auto begin = Clock::now();
    Options options;
    options.scene = arguments.scene;
    options.domain = arguments.domain;
    options.pool_mib = arguments.pool_mib;
    options.wait_s = 60.0;
    options.proxy_speed_m_per_s = 2.0 * arguments.speed_m_per_s;
    options.speed_limit_m_per_s = options.proxy_speed_m_per_s;
    auto client = dds::DdsClient::create(options.domain, "rider", {});
    if (!client)
    {
        return line.fail(client.error().text);
    }
    const auto goes_on = [] { return true; };
    dds::SceneReader reader(client.value()->domain(), client.value()->exchange());
    if (const auto shown = take_shown_scene(options, *client.value(), reader, goes_on); !shown)
    {
        return line.fail(shown.error().text);
    }
    std::vector<ModelSelector> selectors;
    for (const std::string& text : options.models)
    {
        selectors.push_back(parse_selector(text).value());
    }
    auto models = client.value()->find_headers(selectors, std::chrono::seconds(60));
    if (!models)
    {
        return line.fail(models.error().text);
    }
    const Log log = [](const std::string& text) { fmt::print(stderr, "{}\n", text); };
    auto controller = Controller::create(options, std::move(models).value(), log, goes_on);
    if (!controller)
    {
        return line.fail(controller.error().text);
    }
    const double start_ms = ms_since(begin);
    std::size_t bases = 0;
    for (const ServedModel& model : controller.value()->models())
    {
        bases += model.base.empty() ? 0U : 1U;
    }
    Ride ride(*controller.value(), arguments.speed_m_per_s);
    const auto objects = static_cast<std::uint32_t>(controller.value()->objects().size());
    for (std::uint32_t i = 0; i < arguments.visits; ++i)
    {
        ride.visit(i % objects);
    }
    const Figures& figures = ride.figures();
    fmt::print("{}\n", nlohmann::json{{"models", options.models.size()},
                                      {"objects", objects},
                                      {"streamed_models",
                                       controller.value()->setup().for_streamed_models.faces},
                                      {"bases_at_start", bases},
                                      {"start_ms", start_ms},
                                      {"pool_bytes", controller.value()->pool_bytes()},
                                      {"frames", figures.frames},
                                      {"invisible_wall_frames", figures.invisible_wall_frames},
                                      {"latency_miss_frames", figures.latency_miss_frames},
                                      {"visits", figures.visits},
                                      {"touched", figures.touched},
                                      {"came", figures.came},
                                      {"went", figures.went},
                                      {"here_max", figures.here_max},
                                      {"came_ms_max", figures.came_ms_max},
                                      {"longest_frame_ms", figures.late_ms_max}}
                           .dump());
    return kExitDone;
}

} // namespace
} // namespace tactus::hrtc

int main(int argc, char** argv)
{
    return tactus::run_program("scene_rider", "", [&] { return tactus::hrtc::run(argc, argv); });
}
