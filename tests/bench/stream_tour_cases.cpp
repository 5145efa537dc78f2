// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// The whole programs spm_publish and hrtc on loopback and across two networks with a delay.

#include "platform/recording/recording.hpp"
#include "platform/recording/replay.hpp"
#include "tests/bench/published.hpp"
#include "tests/bench/stream_cases.hpp"
#include "tests/bench/stream_run.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <fstream>
#include <functional>
#include <limits>
#include <optional>

namespace tactus::bench
{

namespace
{

using Json = nlohmann::json;

constexpr std::uint32_t kTourTaps = 40;
constexpr std::uint32_t kQuickTourTaps = 3;
constexpr double kFacePool_mib = 4.0;
constexpr double kKilo = 1e3;

/// Writes a file for hrtc's replay device: the tool at these positions of the model frame.
void write_motion(const CaseContext& context, const Scene& scene, const std::vector<Vec3>& goals_m,
                  const std::filesystem::path& file)
{
    const Scene& any = context.scenes.get(kTiny);
    const std::array<double, 3>& origin = scene.model.origin_m;
    const Vec3 origin_m(origin[0], origin[1], origin[2]);
    test::RigOptions options;
    options.record = true;
    test::FrameRig rig(any.model, options);
    for (const Vec3& goal_m : goals_m)
    {
        rig.step(origin_m + goal_m);
    }
    const std::vector<std::byte> bytes = rig.finish_recording();
    std::ofstream stream(file, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
    if (!stream.good())
    {
        throw Failure(file.string() + ": can't be written");
    }
}

/// Both ends on loopback, or each in its own network.
struct Place
{
    std::optional<RelayedNetworks> networks;

    static Place make(double delay_ms, double loss, const std::filesystem::path& folder)
    {
        Place place;
        if (delay_ms >= 0.0)
        {
            place.networks.emplace(RelayedNetworks::make({delay_ms, loss}, folder));
        }
        return place;
    }
    [[nodiscard]] NetworkEnd server() const { return networks ? networks->server() : NetworkEnd{}; }
    [[nodiscard]] NetworkEnd controller() const
    {
        return networks ? networks->controller() : NetworkEnd{};
    }
};

struct HrtcRun
{
    double speed_diag_per_s{0.5};
    double cache_mib{0.0};
    std::size_t frames{0};
};

/// Plays motion.rec and writes out.rec; returns the report.
Json run_hrtc(const Scene& scene, const NetworkEnd& end, const HrtcRun& run,
              const std::filesystem::path& folder)
{
    const double diagonal_m = scene.model.diagonal_m;
    auto hrtc = start_at(end, "hrtc", folder,
                         {"--model",
                          "model",
                          "--allow-no-rt",
                          "--device",
                          "replay:" + (folder / "motion.rec").string(),
                          "--tool",
                          fmt::format("sphere:{:.9f}", kRadius_diag * diagonal_m),
                          "--pool-mib",
                          fmt::format("{}", 2.0 * run.cache_mib + kFacePool_mib),
                          "--cache-mib",
                          fmt::format("{}", run.cache_mib),
                          "--splits",
                          fmt::format("{}", tour_splits(run.speed_diag_per_s)),
                          "--proxy-speed",
                          fmt::format("{}", kTourFollow * run.speed_diag_per_s * diagonal_m),
                          "--duration",
                          fmt::format("{}", static_cast<double>(run.frames) * kPeriod_s),
                          "--wait",
                          "60",
                          "--record",
                          folder / "out.rec",
                          "--report",
                          folder / "report.json"});
    hrtc.wait();
    std::ifstream report(folder / "report.json");
    return Json::parse(report);
}

/// Calls `look` with each frame's output in out.rec.
void look_at_frames(const std::filesystem::path& folder,
                    const std::function<void(const FrameOutput&)>& look)
{
    const auto recording = needed(Recording::read((folder / "out.rec").string()));
    ReplayWatch watch;
    watch.ends = [&](std::uint64_t, const RecordedFrame&, const FrameOutput& output)
    { look(output); };
    const auto report = needed(replay(recording, nullptr, watch));
    if (report.difference || recording.lost_from() != kNoFrame)
    {
        throw Failure(replay_line(recording, report));
    }
}

double number_of(const Json& value)
{
    return value.is_number() ? value.get<double>() : 0.0;
}

} // namespace

void run_tour_case(const CaseContext& context, const TourCase& test_case)
{
    const Scene& scene = context.scenes.get(test_case.scene);
    const test::TemporaryFolder folder("tour");
    TourManner manner;
    manner.speed_diag_per_s = test_case.speed_diag_per_s;
    manner.taps = context.options.quick ? kQuickTourTaps : kTourTaps;
    const TapTour tour = tap_tour(scene.touch(), manner);
    write_motion(context, scene, tour.goals_m, folder.path() / "motion.rec");
    auto place = Place::make(test_case.delay_ms, test_case.loss, folder.path());
    const auto server = publish(scene, place.server(), folder.path());
    const auto report = run_hrtc(
        scene, place.controller(),
        {test_case.speed_diag_per_s, test_case.cache_mib, tour.goals_m.size()}, folder.path());
    StreamCounter counter(tour);
    look_at_frames(folder.path(), [&](const FrameOutput& output) { counter.add(output); });
    const StreamFigures& figures = counter.figures();
    Row common = context.common_row(scene.model.name, "tours, whole programs");
    common.frames = figures.frames;
    common.hash = figures.hash;
    CaseRows rows(context.rows, common);
    rows.add("open", figures.percent(figures.open), "%", goal_if(test_case.open_max));
    rows.add("late taps", static_cast<double>(figures.late_taps), "",
             goal_if(test_case.late_taps_max));
    rows.add("taps", static_cast<double>(figures.taps), "");
    rows.add("waiting", figures.percent(figures.waiting), "%");
    const Json& arrival = report["wire"]["arrival_ms"];
    rows.add("arrival p50", number_of(arrival["p50"]), "ms");
    rows.add("arrival p99", number_of(arrival["p99"]), "ms", goal_if(test_case.arrival_p99_ms));
    rows.add("arrival max", number_of(arrival["max"]), "ms");
    rows.add("wire",
             report["wire"]["bytes_received"].get<double>() / kKilo /
                 (static_cast<double>(figures.frames) * kPeriod_s),
             "kB/s");
    rows.add("reloads", figures.per_second(figures.reloads), "/s");
    rows.add("overruns", number_of(report["deadline"]["overrun"]), "");
    rows.add("late frames", number_of(report["deadline"]["missed"]), "");
}

void run_first_touch_case(const CaseContext& context, const FirstTouchCase& test_case)
{
    constexpr std::size_t kFrames = 1'000;
    constexpr double kCache_mib = 4.5;
    const Scene& scene = context.scenes.get(test_case.scene);
    const test::TemporaryFolder folder("first-touch");
    TourManner manner;
    manner.taps = 1;
    const TapTour tour = tap_tour(scene.touch(), manner);
    const Vec3 touching_m = tour.goals_m[tour.touches.at(0)];
    const Vec3 away_m = touching_m + Vec3(10.0, 0.0, 0.0) * scene.model.diagonal_m;
    double payload_kb = 0.0;
    std::uint64_t first_request = 0;
    std::uint64_t first_exact = 0;
    std::uint64_t loads = 0;
    std::uint64_t hash = 0;
    // The cost of a run without requests is subtracted.
    for (const bool touches : {false, true})
    {
        const std::vector<Vec3> goals_m(kFrames, touches ? touching_m : away_m);
        write_motion(context, scene, goals_m, folder.path() / "motion.rec");
        auto place = Place::make(test_case.delay_ms, 0.0, folder.path());
        const auto server = publish(scene, place.server(), folder.path());
        const auto report =
            run_hrtc(scene, place.controller(), {0.5, kCache_mib, kFrames}, folder.path());
        const auto traffic = place.networks->traffic();
        const double all_kb = static_cast<double>(traffic.payload_bytes) / kKilo;
        payload_kb = touches ? all_kb - payload_kb : all_kb;
        std::uint64_t frame = 0;
        first_request = first_exact = loads = 0;
        look_at_frames(folder.path(),
                       [&](const FrameOutput& output)
                       {
                           ++frame;
                           hash += output.models[0].state_hash * (2 * frame + 1);
                           loads += output.work.pages_adopted;
                           first_request = first_request == 0 && output.work.requests > 0
                                               ? frame
                                               : first_request;
                           const bool is_exact =
                               touches && output.pairs[0].kind == AnswerKind::exact;
                           first_exact = first_exact == 0 && is_exact ? frame : first_exact;
                       });
    }
    Row common = context.common_row(scene.model.name, "first touch, cold");
    common.frames = kFrames;
    common.hash = hash;
    CaseRows rows(context.rows, common);
    rows.add("UDP payload", payload_kb, "kB", goal_if(test_case.payload_kb));
    rows.add("first request to exact",
             first_exact == 0
                 ? std::numeric_limits<double>::quiet_NaN()
                 : static_cast<double>(first_exact - first_request) * kPeriod_s * kKilo,
             "ms", goal_if(test_case.time_ms));
    rows.add("pieces", static_cast<double>(loads), "");
}

} // namespace tactus::bench
