// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Suite `stream`: prediction, cache and transport for a hand on a model larger than the
/// controller's memory. Lists the cases with their goals.

#include "platform/recording/recording.hpp"
#include "platform/recording/replay.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"
#include "tests/bench/bench_row.hpp"
#include "tests/bench/cases.hpp"
#include "tests/bench/program.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/bench/suites.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/surface_slide.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <vector>

namespace tactus::bench
{
namespace
{

/// Parameters of a tour around a model with taps and slides.
struct TourManner
{
    double speed_diag_per_s{0.5};
    std::uint32_t taps{40};
    double tremor_m{0.0}; ///< Uniform noise on each axis of each sample, up to this.
};

/// Tour and the frames in which its taps meet the surface.
struct TapTour
{
    std::vector<Vec3> goals_m;
    std::vector<std::size_t> touches; ///< First frame of each tap within the tool's radius.
};

/// Result of streaming for a tour.
struct StreamFigures
{
    std::uint64_t frames{0};
    std::uint64_t exact{0};
    std::uint64_t open{0}; ///< Frames with neither an exact nor a separated answer.
    std::uint64_t taps{0};
    /// Taps whose first frame in touch was open or had a waiting proxy.
    std::uint64_t late_taps{0};
    std::uint64_t hits{0};   ///< Lookups of wanted chunks that were resident.
    std::uint64_t misses{0}; ///< Requests.
    std::uint64_t loads{0};
    std::uint64_t reloads{0};       ///< Reloads of chunks that were resident before.
    std::uint64_t reload_bursts{0}; ///< Sequences of reloads without a pause of half a second.
    std::uint64_t bytes{0};         ///< Coded bytes.
    std::uint64_t hash{0};

    [[nodiscard]] double percent(std::uint64_t count) const
    {
        return 100.0 * static_cast<double>(count) / static_cast<double>(frames);
    }
    [[nodiscard]] double per_second(std::uint64_t count) const
    {
        return static_cast<double>(count) / (static_cast<double>(frames) * kPeriod_s);
    }
};

/// Counts the results of consecutive frames.
class StreamCounter
{
public:
    explicit StreamCounter(const TapTour& tour) : tour_(tour) {}

    /// Adds the output of a tour's next frame.
    void add(const FrameOutput& output);
    [[nodiscard]] const StreamFigures& figures() const { return figures_; }

private:
    void count_loads(std::span<const QueueEvent> events);

    const TapTour& tour_;
    StreamFigures figures_;
    std::set<std::uint32_t> seen_;
    std::uint64_t burst_ends_{0};
};

/// Tour over a model whose chunks arrive a fixed number of frames after their request.
struct StreamRun
{
    const Scene& scene;
    const TapTour& tour;
    std::uint32_t latency_frames{20};
    test::RigOptions rig;
    Budgets budgets;
};

constexpr double kTapTurn_rad_per_s = 3.0;
/// Height of the flights above the surface, of the tool's own surface.
constexpr double kTapFlight_diag = 0.03;
constexpr std::uint32_t kFlightSteps = 250;
constexpr std::uint32_t kSlideSteps = 500;

class Tour
{
public:
    Tour(const TouchScene& scene, const TourManner& manner)
        : scene_(scene)
        , manner_(manner)
        , step_m_(manner.speed_diag_per_s * scene.diagonal_m * kPeriod_s)
    {
        const Vec3 middle = 0.5 * (scene.tree.low_m() + scene.tree.high_m());
        goals_m_.emplace_back(middle.x(), middle.y(),
                              scene.tree.high_m().z() + kTapFlight_diag * scene.diagonal_m);
    }

    TapTour make()
    {
        for (std::uint32_t tap = 0; tap < manner_.taps; ++tap)
        {
            blend(kRadius_diag + kTapFlight_diag, 0, kFlightSteps);
            blend(kRadius_diag, kDeepest, kSlideSteps);
        }
        TapTour tour;
        tour.goals_m = std::move(goals_m_);
        tour.touches = first_touches(tour.goals_m);
        tremble(tour.goals_m);
        return tour;
    }

private:
    /// Frame of the greatest depth of a slide: half a swing.
    static constexpr std::uint32_t kDeepest = test::SurfaceSlide::kSwingFrames / 2;

    /// Moves straight to the start of the slide, then along the surface.
    void blend(double radius_diag, std::uint32_t first_frame, std::uint32_t steps)
    {
        go_to_distance(test::SurfaceSlide::wanted_distance_diag(radius_diag, first_frame));
        test::SlideManner slide;
        slide.diagonal_m = scene_.diagonal_m;
        slide.radius_diag = radius_diag;
        slide.step_m = step_m_;
        slide.rotation_rad = kTapTurn_rad_per_s * kPeriod_s;
        slide.first_frame = first_frame;
        slide.rotation_rate = [seed = kSeed + goals_m_.size()](std::uint64_t turn)
        { return test::signed_unit(seed, turn); };
        test::SurfaceSlide along(scene_.tree, slide, goals_m_.back());
        for (std::uint32_t i = 0; i < steps; ++i)
        {
            goals_m_.push_back(along.next());
        }
    }

    /// Moves straight to or from the nearest point of the surface.
    void go_to_distance(double distance_diag)
    {
        const Vec3 from = goals_m_.back();
        const test::FaceTree::Nearest nearest = scene_.tree.nearest(from);
        const Vec3 normal = (from - nearest.point_m).normalized();
        const Vec3 to = nearest.point_m + distance_diag * scene_.diagonal_m * normal;
        const auto frames = static_cast<std::uint32_t>(std::ceil((to - from).norm() / step_m_)) + 1;
        for (std::uint32_t i = 1; i <= frames; ++i)
        {
            goals_m_.emplace_back(from + (to - from) * (static_cast<double>(i) / frames));
        }
    }

    [[nodiscard]] std::vector<std::size_t> first_touches(const std::vector<Vec3>& goals_m) const
    {
        std::vector<std::size_t> touches;
        bool was_near = false;
        const double reach_m = kRadius_diag * scene_.diagonal_m;
        for (std::size_t i = 0; i < goals_m.size(); ++i)
        {
            const double distance_m = scene_.tree.nearest(goals_m[i]).distance_m;
            if (!was_near && distance_m <= reach_m)
            {
                touches.push_back(i);
                was_near = true;
            }
            was_near =
                was_near && distance_m <= reach_m + 0.5 * kTapFlight_diag * scene_.diagonal_m;
        }
        return touches;
    }

    void tremble(std::vector<Vec3>& goals_m) const
    {
        for (std::size_t i = 0; manner_.tremor_m > 0.0 && i < goals_m.size(); ++i)
        {
            goals_m[i] += manner_.tremor_m * Vec3(test::signed_unit(kSeed + 2, 3 * i),
                                                  test::signed_unit(kSeed + 2, 3 * i + 1),
                                                  test::signed_unit(kSeed + 2, 3 * i + 2));
        }
    }

    const TouchScene& scene_;
    TourManner manner_;
    double step_m_;
    std::vector<Vec3> goals_m_;
};

/// Taps all over the model, each after a flight of a quarter of a second at 3 % of the diagonal
/// above the surface, and followed by a slide of half a second. Everything, the descent included,
/// is at the manner's speed on average. Headings change by up to 3 rad/s. Computed from the mesh
/// alone, for a tool of kRadius_diag.
TapTour tap_tour(const TouchScene& scene, const TourManner& manner)
{
    return Tour(scene, manner).make();
}

/// Reloads closer together belong to one burst.
constexpr std::uint64_t kBurstFrames = 500;

bool is_settled(AnswerKind kind)
{
    return kind == AnswerKind::exact || kind == AnswerKind::separated;
}

void StreamCounter::add(const FrameOutput& output)
{
    const AnswerKind kind = output.pairs[0].kind;
    const ToolOutput& tool = output.tools[0];
    figures_.open += is_settled(kind) ? 0U : 1U;
    figures_.exact += kind == AnswerKind::exact ? 1U : 0U;
    figures_.hits += output.work.cache_hits;
    figures_.misses += output.work.cache_misses;
    if (figures_.taps < tour_.touches.size() && tour_.touches[figures_.taps] == figures_.frames)
    {
        ++figures_.taps;
        figures_.late_taps += is_settled(kind) && !tool.halted && !tool.data_limited ? 0U : 1U;
    }
    count_loads(output.queues.events);
    figures_.hash += output.models[0].state_hash * (2 * figures_.frames + 1);
    ++figures_.frames;
}

void StreamCounter::count_loads(std::span<const QueueEvent> events)
{
    bool reloads = false;
    for (const QueueEvent& event : events)
    {
        if (event.kind == QueueEventKind::arrival && event.key.kind == ContentKind::chunk)
        {
            ++figures_.loads;
            const bool is_new = seen_.insert(event.key.number).second;
            figures_.reloads += is_new ? 0U : 1U;
            reloads = reloads || !is_new;
        }
    }
    if (reloads)
    {
        figures_.reload_bursts += figures_.frames >= burst_ends_ ? 1U : 0U;
        burst_ends_ = figures_.frames + kBurstFrames;
    }
}

StreamFigures stream(const StreamRun& run)
{
    test::RigOptions options = run.rig;
    options.chunk_loader_steps_per_frame = 1;
    options.faults.delay_polls_min = run.latency_frames;
    options.faults.delay_polls_max = run.latency_frames;
    test::FrameRig rig(run.scene.model, options);
    StreamCounter counter(run.tour);
    for (const Vec3& goal_m : run.tour.goals_m)
    {
        counter.add(rig.step(goal_m, run.budgets));
    }
    StreamFigures figures = counter.figures();
    figures.bytes = rig.chunk_loader().counters().coded_bytes;
    return figures;
}

/// Proxy speed limit of all tours, relative to the tour's speed.
inline constexpr double kTourFollow = 1.5;

/// Splits and merges of a tour's frames.
[[nodiscard]] constexpr std::uint32_t tour_splits(double speed_diag_per_s)
{
    return speed_diag_per_s < 1.0 ? 64 : 128;
}

struct PredictionCase
{
    SceneSource scene;
    double speed_diag_per_s;
    std::uint32_t latency_ms;
    double cache_mib;
    double tremor_diag{0.0};
};

struct CacheCase
{
    SceneSource scene;
    double small_mib;
    double larger_mib;
};

/// Goals in percent of the frames, counts and milliseconds.
struct TourCase
{
    SceneSource scene;
    double speed_diag_per_s;
    double cache_mib;
    double delay_ms; ///< Delay each way; negative: loopback.
    double loss{0.0};
    double open_max{kNoGoal};
    double late_taps_max{kNoGoal};
    double arrival_p99_ms{kNoGoal};
};

struct FirstTouchCase
{
    SceneSource scene;
    double delay_ms;
    double payload_kb{kNoGoal};
    double time_ms{kNoGoal};
};

struct ThroughputCase
{
    SceneSource scene;
    double mb_per_s;
};

struct FanOutCase
{
    SceneSource scene;
    std::uint32_t clients;
    double rate_hz;
    bool stops_one; ///< One client is stopped halfway, like by SIGSTOP.
    double p99_ms{kNoGoal};
};

// Prediction and cache, in virtual time: the same figures in every run.

constexpr std::uint32_t kTaps = 40;
constexpr std::uint32_t kQuickTaps = 6;
/// Frames that the automatic choice may leave open beyond the best method.
constexpr double kAutomaticGoal = 2.0;

/// Pools besides the pages, large enough not to limit.
constexpr std::size_t kFacePool_bytes = std::size_t{4} << 20U;

StreamRun make_run(const Scene& scene, const TapTour& tour, double speed_diag_per_s,
                   std::uint32_t latency_ms, double cache_mib)
{
    StreamRun run{scene, tour, latency_ms, {}, {}};
    ToolSpec tool;
    tool.radius_m = kRadius_diag * scene.model.diagonal_m;
    tool.speed_max_m_per_s = kTourFollow * speed_diag_per_s * scene.model.diagonal_m;
    run.rig.tools = {tool};
    run.rig.cache_bytes = static_cast<std::size_t>(cache_mib * 0x1p20);
    run.rig.pool_bytes = 2 * run.rig.cache_bytes + kFacePool_bytes;
    run.budgets.splits = run.budgets.merges = tour_splits(speed_diag_per_s);
    return run;
}

TapTour make_tour(const CaseContext& context, const Scene& scene, double speed_diag_per_s,
                  double tremor_diag)
{
    TourManner manner;
    manner.speed_diag_per_s = speed_diag_per_s;
    manner.taps = context.options.quick ? kQuickTaps : kTaps;
    manner.tremor_m = tremor_diag * scene.model.diagonal_m;
    return tap_tour(scene.touch(), manner);
}

/// A tour with each prediction method, in virtual time.
void run_prediction_case(const CaseContext& context, const PredictionCase& test_case)
{
    const Scene& scene = context.scenes.get(test_case.scene);
    const TapTour tour =
        make_tour(context, scene, test_case.speed_diag_per_s, test_case.tremor_diag);
    StreamRun run = make_run(scene, tour, test_case.speed_diag_per_s, test_case.latency_ms,
                             test_case.cache_mib);
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i <= kPredictions; ++i)
    {
        run.rig.prediction = static_cast<Prediction>(i);
        const StreamFigures figures = stream(run);
        Row common = context.common_row(scene.model.name, "prediction");
        common.by = prediction_name(run.rig.prediction);
        common.frames = figures.frames;
        common.hash = figures.hash;
        CaseRows rows(context.rows, common);
        const double open = figures.percent(figures.open);
        rows.add("open", open, "%");
        rows.add("late taps", static_cast<double>(figures.late_taps), "");
        rows.add("wire", figures.per_second(figures.bytes) * 1e-3, "kB/s");
        if (run.rig.prediction == Prediction::automatic)
        {
            rows.add("open above the best", open - best, "points", kAutomaticGoal);
        }
        best = std::min(best, open);
    }
}

/// The four regimes of figure 5 of the 3DIM 2005 paper: no cache, a small one, a larger one, the
/// whole model.
void run_cache_case(const CaseContext& context, const CacheCase& test_case)
{
    constexpr double kSpeed_diag_per_s = 0.5;
    constexpr std::uint32_t kLatency_ms = 20;
    const Scene& scene = context.scenes.get(test_case.scene);
    const TapTour tour = make_tour(context, scene, kSpeed_diag_per_s, 0.0);
    struct Regime
    {
        const char* name;
        double cache_mib;
        bool is_off;
        bool is_whole;
    };
    const double whole_mib = 1.5 * static_cast<double>(scene.model.faces.size()) * 64.0 * 0x1p-20;
    for (const Regime& regime : {Regime{"none", test_case.larger_mib, true, false},
                                 Regime{"small", test_case.small_mib, false, false},
                                 Regime{"larger", test_case.larger_mib, false, false},
                                 Regime{"all of it", whole_mib, false, true}})
    {
        StreamRun run = make_run(scene, tour, kSpeed_diag_per_s, kLatency_ms, regime.cache_mib);
        run.rig.cache_off = regime.is_off;
        run.rig.static_when_it_fits = regime.is_whole;
        run.rig.pool_bytes *= regime.is_whole ? 3 : 1;
        const StreamFigures figures = stream(run);
        Row common = context.common_row(scene.model.name, "cache");
        common.by = regime.name;
        common.frames = figures.frames;
        common.hash = figures.hash;
        CaseRows rows(context.rows, common);
        const auto looks = static_cast<double>(figures.hits + figures.misses);
        rows.add("pages", regime.cache_mib, "MiB");
        rows.add("hits", 100.0 * static_cast<double>(figures.hits) / std::max(looks, 1.0), "%");
        rows.add("loads", figures.per_second(figures.loads), "/s");
        rows.add("reloads", figures.per_second(figures.reloads), "/s");
        rows.add("bursts of reloads", figures.per_second(figures.reload_bursts), "/s");
        rows.add("wire", figures.per_second(figures.bytes) * 1e-3, "kB/s");
        rows.add("exact", figures.percent(figures.exact), "%");
        rows.add("open", figures.percent(figures.open), "%");
        rows.add("late taps", static_cast<double>(figures.late_taps), "");
    }
}

// A publisher and many clients on loopback: throughput and number of clients.

using Json = nlohmann::json;

std::string client_name(std::uint32_t number)
{
    return fmt::format("client-{}", number);
}

Program start_client(const std::filesystem::path& folder, std::uint32_t number, double rate_hz,
                     double seconds)
{
    std::filesystem::create_directory(folder / client_name(number));
    return start_at({}, "stream_client", folder / client_name(number),
                    {"--model", "model", "--name", client_name(number), "--rate",
                     fmt::format("{}", rate_hz), "--seconds", fmt::format("{}", seconds)});
}

Json client_report(Program& client, const std::filesystem::path& folder, std::uint32_t number)
{
    client.wait();
    return report_in(folder / client_name(number) / "stream_client.log");
}

/// spm_publish and one client on loopback, as fast as chunks arrive.
void run_throughput_case(const CaseContext& context, const ThroughputCase& test_case)
{
    constexpr double kSeconds = 5.0;
    const Scene& scene = context.scenes.get(test_case.scene);
    const test::TemporaryFolder folder("throughput");
    const auto server = publish(scene, {}, folder.path());
    auto client = start_client(folder.path(), 0, 0.0, kSeconds);
    const auto report = client_report(client, folder.path(), 0);
    CaseRows rows(context.rows, context.common_row(scene.model.name, "throughput"));
    const double seconds = report["seconds"].get<double>();
    rows.add("samples", report["link_bytes"].get<double>() * 1e-6 / seconds, "MB/s",
             test_case.mb_per_s)
        .is_least = true;
}

/// spm_publish and many clients on loopback, each at a rate.
void run_fan_out_case(const CaseContext& context, const FanOutCase& test_case)
{
    constexpr double kSeconds = 10.0;
    constexpr double kServedGoal = 95.0; // The last chunks are in transit at the end.
    const Scene& scene = context.scenes.get(test_case.scene);
    const test::TemporaryFolder folder("fan-out");
    const auto server = publish(scene, {}, folder.path());
    CaseRows rows(context.rows, context.common_row(scene.model.name, "many controllers"));
    double before_ms = 0.0;
    for (const bool stops_one : {false, true})
    {
        if (stops_one && !test_case.stops_one)
        {
            break;
        }
        std::vector<Program> clients;
        for (std::uint32_t i = 0; i < test_case.clients; ++i)
        {
            clients.push_back(start_client(folder.path(), i, test_case.rate_hz, kSeconds));
        }
        for (const Program& client : clients)
        {
            client.wait_for("connected", kStartTimeout);
        }
        if (stops_one)
        {
            clients[0].send_signal(SIGSTOP);
        }
        double p99_ms = 0.0;
        double least_share = 1.0;
        for (std::uint32_t i = stops_one ? 1 : 0; i < test_case.clients; ++i)
        {
            const auto report = client_report(clients[i], folder.path(), i);
            p99_ms = std::max(p99_ms, report["p99_ms"].get<double>());
            least_share = std::min(least_share,
                                   report["pieces"].get<double>() / (test_case.rate_hz * kSeconds));
        }
        const char* when = stops_one ? "one stopped: " : "";
        rows.add(fmt::format("{}worst p99", when), p99_ms, "ms", goal_if(test_case.p99_ms));
        rows.add(fmt::format("{}least served", when), 100.0 * least_share, "%", kServedGoal)
            .is_least = true;
        if (stops_one)
        {
            rows.add("worst p99 above before", 100.0 * (p99_ms / before_ms - 1.0), "%", 10.0);
        }
        before_ms = p99_ms;
    }
}

// The whole programs spm_publish and hrtc on loopback and across two networks with a delay.

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

/// A tour with the whole programs spm_publish and hrtc over DDS.
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
    const Json& arrival = report["wire"]["arrival_ms"];
    rows.add("arrival p50", number_of(arrival["p50"]), "ms");
    rows.add("arrival p99", number_of(arrival["p99"]), "ms", goal_if(test_case.arrival_p99_ms));
    rows.add("wire",
             report["wire"]["bytes_received"].get<double>() / kKilo /
                 (static_cast<double>(figures.frames) * kPeriod_s),
             "kB/s");
}

/// Whole programs: hrtc starts in touch, with only the model's header and base mesh.
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
        first_request = first_exact = 0;
        look_at_frames(folder.path(),
                       [&](const FrameOutput& output)
                       {
                           ++frame;
                           hash += output.models[0].state_hash * (2 * frame + 1);
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
}

constexpr SceneSource kSmall{"small", nullptr, 0, 60'000};

std::vector<Case> stream_cases()
{
    const auto predict = [](const char* name, When when, const PredictionCase& test_case)
    { return make_case(name, when, run_prediction_case, test_case); };
    const auto tour = [](const char* name, When when, const TourCase& test_case)
    { return make_case(name, when, run_tour_case, test_case); };
    return {
        predict("0.1 diag/s, 20 ms", When::full_only, {kFineBunny, 0.1, 20, 2.2}),
        predict("0.5 diag/s, 5 ms", When::full_only, {kFineBunny, 0.5, 5, 2.2}),
        predict("0.5 diag/s, 20 ms", When::full_only, {kFineBunny, 0.5, 20, 2.2}),
        predict("0.5 diag/s, 20 ms, tremor", When::full_only, {kFineBunny, 0.5, 20, 2.2, 2e-4}),
        predict("0.5 diag/s, 50 ms", When::full_only, {kFineBunny, 0.5, 50, 4.5}),
        predict("2 diag/s, 5 ms", When::full_only, {kFineBunny, 2.0, 5, 4.5}),
        predict("2 diag/s, 20 ms", When::full_only, {kFineBunny, 2.0, 20, 4.5}),
        predict("2 diag/s, 20 ms, tremor", When::full_only, {kFineBunny, 2.0, 20, 4.5, 2e-4}),
        predict("predict-small", When::always, {kSmall, 0.5, 20, 1.0}),
        make_case("cache-1.1M", When::full_only, run_cache_case, CacheCase{kFineBunny, 1.0, 4.5}),
        make_case("cache-small", When::always, run_cache_case, CacheCase{kSmall, 0.5, 1.5}),
        tour("1.1M, 0.5 diag/s, loopback", When::full_only, {kFineBunny, 0.5, 2.2, -1.0}),
        tour("1.1M, 0.5 diag/s, 10 ms", When::full_only,
             {kFineBunny, 0.5, 2.2, 10.0, 0.0, 0.5, 0.0}),
        tour("1.1M, 0.5 diag/s, 10 ms, 1 % lost", When::full_only,
             {kFineBunny, 0.5, 2.2, 10.0, 0.01, 1.5, kNoGoal, 70.0}),
        tour("1.1M, 2 diag/s, 10 ms", When::full_only, {kFineBunny, 2.0, 4.5, 10.0, 0.0, 5.0}),
        tour("1.1M, 2 diag/s, 10 ms, 1 % lost", When::full_only,
             {kFineBunny, 2.0, 4.5, 10.0, 0.01, 6.0, kNoGoal, 70.0}),
        tour("small, 0.5 diag/s, loopback", When::always, {kSmall, 0.5, 1.0, -1.0}),
        make_case("first touch, 4.3M", When::full_only, run_first_touch_case,
                  FirstTouchCase{kFineIgea, 10.0, 150.0, 90.0}),
        make_case("throughput", When::full_only, run_throughput_case,
                  ThroughputCase{kFineBunny, 100.0}),
        make_case("8 clients, one stopped", When::full_only, run_fan_out_case,
                  FanOutCase{kFineBunny, 8, 100.0, true, 25.0}),
        make_case("64 clients", When::full_only, run_fan_out_case,
                  FanOutCase{kFineBunny, 64, 10.0, false}),
    };
}

} // namespace

Suite stream_suite()
{
    return {"stream", stream_cases};
}

} // namespace tactus::bench
