// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Whole programs over DDS, on loopback and across two networks with a delay between them.

#include "platform/recording/replay.hpp"
#include "tests/bench/asking_client.hpp"
#include "tests/bench/frame_replay.hpp"
#include "tests/bench/random.hpp"
#include "tests/bench/relayed_networks.hpp"
#include "tests/bench/stream_cases.hpp"
#include "tests/bench/stream_run.hpp"
#include "transport/dds/dds_client.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <thread>
#include <unistd.h>

namespace tactus::bench
{

namespace
{

using Json = nlohmann::json;

constexpr std::uint32_t kTaps = 40;
constexpr std::uint32_t kQuickTaps = 3;
constexpr double kFacePool_mib = 4.0;
constexpr std::chrono::seconds kStartTimeout{60};
constexpr double kKilo = 1e3;

/// A domain that nobody else in this machine uses, most likely.
std::string domain()
{
    return fmt::format("{}", ::getpid() % 231);
}

/// Either both ends on loopback or each in a network of its own.
struct Place
{
    std::optional<RelayedNetworks> networks;

    static Result<Place, SceneError> make(double delay_ms, double loss,
                                          const std::filesystem::path& folder)
    {
        Place place;
        if (delay_ms >= 0.0)
        {
            auto made = RelayedNetworks::make({delay_ms, loss}, folder);
            if (!made)
            {
                return made.error();
            }
            place.networks.emplace(std::move(made).value());
        }
        return place;
    }
    [[nodiscard]] NetworkEnd host() const { return networks ? networks->host() : loopback_end(); }
    [[nodiscard]] NetworkEnd controller() const
    {
        return networks ? networks->controller() : loopback_end();
    }
};

ProgramSetup at(const NetworkEnd& end, const std::filesystem::path& output,
                std::vector<std::string> words)
{
    ProgramSetup setup;
    setup.words = std::move(words);
    setup.network = end.network;
    setup.dds_uri = end.dds_uri;
    setup.output = output;
    return setup;
}

Result<Program, SceneError> publish(const Scene& scene, const NetworkEnd& end,
                                    const std::filesystem::path& folder)
{
    auto host = Program::start(at(
        end, folder / "spm_publish.log",
        {program_path("spm_publish"), scene.model.path, "--name", "model", "--domain", domain()}));
    if (host)
    {
        if (auto ready = host.value().wait_for("ready on DDS domain", kStartTimeout); !ready)
        {
            return ready.error();
        }
    }
    return host;
}

/// A file that hrtc's replay device plays: the tool at these places of the model's frame.
Result<Done, SceneError> write_motion(const CaseContext& context, const Scene& scene,
                                      const std::vector<Vec3>& goals_m,
                                      const std::filesystem::path& file)
{
    const auto any = context.scenes.get(kTiny);
    if (!any)
    {
        return any.error();
    }
    const std::array<double, 3>& origin = scene.model.origin_m;
    const Vec3 origin_m(origin[0], origin[1], origin[2]);
    test::RigOptions options;
    options.record = true;
    test::FrameRig rig(any.value()->model, options);
    for (const Vec3& goal_m : goals_m)
    {
        rig.step(origin_m + goal_m);
    }
    const std::vector<std::byte> bytes = rig.finish_recording();
    std::ofstream stream(file, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
    return stream.good() ? Result<Done, SceneError>(Done{})
                         : SceneError{file.string() + ": can't be written"};
}

struct HrtcRun
{
    double speed_diag_per_s{0.5};
    double cache_mib{0.0};
    std::size_t frames{0};
};

/// Plays motion.rec and leaves out.rec; returns the report.
Result<Json, SceneError> run_hrtc(const Scene& scene, const NetworkEnd& end, const HrtcRun& run,
                                  const std::filesystem::path& folder)
{
    const double diagonal_m = scene.model.diagonal_m;
    auto hrtc =
        Program::start(at(end, folder / "hrtc.log",
                          {program_path("hrtc"),
                           "--model",
                           "model",
                           "--domain",
                           domain(),
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
                           "--follow-speed",
                           fmt::format("{}", kTourFollow * run.speed_diag_per_s * diagonal_m),
                           "--duration",
                           fmt::format("{}", static_cast<double>(run.frames) * kPeriod_s),
                           "--wait",
                           "60",
                           "--record",
                           folder / "out.rec",
                           "--report",
                           folder / "report.json"}));
    if (!hrtc)
    {
        return hrtc.error();
    }
    if (auto done = hrtc.value().wait(); !done)
    {
        return done.error();
    }
    std::ifstream report(folder / "report.json");
    return Json::parse(report);
}

/// Calls `look` with what each frame of out.rec returned.
CaseFailure look_at_frames(const std::filesystem::path& folder,
                           const std::function<void(const FrameOutput&)>& look)
{
    const auto recording = Recording::read((folder / "out.rec").string());
    if (!recording)
    {
        return recording.error().text;
    }
    ReplayWatch watch;
    watch.ends = [&](std::uint64_t, const RecordedFrame&, const FrameOutput& output)
    { look(output); };
    const auto report = replay(recording.value(), nullptr, watch);
    if (!report)
    {
        return report.error().text;
    }
    if (report.value().difference || recording.value().lost_from() != kNoFrame)
    {
        return replay_line(recording.value(), report.value());
    }
    return std::nullopt;
}

Row common_row(const CaseContext& context, const char* part, const Scene& scene)
{
    Row common;
    common.suite = "stream";
    common.part = part;
    common.test_case = context.name;
    common.scene = scene.model.name;
    common.seed = kSeed;
    return common;
}

double number_of(const Json& value)
{
    return value.is_number() ? value.get<double>() : 0.0;
}

} // namespace

CaseFailure run_tour_case(const CaseContext& context, const TourCase& test_case)
{
    const auto scene = context.scenes.get(test_case.scene);
    if (!scene)
    {
        return scene.error().text;
    }
    const test::TemporaryFolder folder("tour");
    TourManner manner;
    manner.speed_diag_per_s = test_case.speed_diag_per_s;
    manner.taps = context.options.quick ? kQuickTaps : kTaps;
    const TapTour tour = tap_tour(scene.value()->touch(), manner);
    if (auto written =
            write_motion(context, *scene.value(), tour.goals_m, folder.path() / "motion.rec");
        !written)
    {
        return written.error().text;
    }
    auto place = Place::make(test_case.delay_ms, test_case.loss, folder.path());
    if (!place)
    {
        return place.error().text;
    }
    const auto host = publish(*scene.value(), place.value().host(), folder.path());
    if (!host)
    {
        return host.error().text;
    }
    const auto report = run_hrtc(
        *scene.value(), place.value().controller(),
        {test_case.speed_diag_per_s, test_case.cache_mib, tour.goals_m.size()}, folder.path());
    if (!report)
    {
        return report.error().text;
    }
    StreamCounter counter(tour);
    if (const CaseFailure failure =
            look_at_frames(folder.path(), [&](const FrameOutput& output) { counter.add(output); }))
    {
        return failure;
    }
    const StreamFigures& figures = counter.figures();
    Row common = common_row(context, "tours, whole programs", *scene.value());
    common.frames = figures.frames;
    CaseRows rows(context.rows, common);
    rows.add("open", figures.percent(figures.open), "%", goal_if(test_case.open_max));
    rows.add("late taps", static_cast<double>(figures.late_taps), "",
             goal_if(test_case.late_taps_max));
    rows.add("taps", static_cast<double>(figures.taps), "");
    rows.add("waiting", figures.percent(figures.waiting), "%");
    const Json& arrival = report.value()["wire"]["arrival_ms"];
    rows.add("arrival p50", number_of(arrival["p50"]), "ms");
    rows.add("arrival p99", number_of(arrival["p99"]), "ms", goal_if(test_case.arrival_p99_ms));
    rows.add("arrival max", number_of(arrival["max"]), "ms");
    rows.add("wire",
             report.value()["wire"]["bytes_received"].get<double>() / kKilo /
                 (static_cast<double>(figures.frames) * kPeriod_s),
             "kB/s");
    rows.add("reloads", figures.per_second(figures.reloads), "/s");
    rows.add("own faults", number_of(report.value()["deadline"]["own_fault"]), "");
    rows.add("late frames", number_of(report.value()["deadline"]["missed"]), "");
    return std::nullopt;
}

CaseFailure run_first_touch_case(const CaseContext& context, const FirstTouchCase& test_case)
{
    constexpr std::size_t kFrames = 1'000;
    constexpr double kCache_mib = 4.5;
    const auto scene = context.scenes.get(test_case.scene);
    if (!scene)
    {
        return scene.error().text;
    }
    const test::TemporaryFolder folder("first-touch");
    TourManner manner;
    manner.taps = 1;
    const TapTour tour = tap_tour(scene.value()->touch(), manner);
    const Vec3 touching_m = tour.goals_m[tour.touches.at(0)];
    const Vec3 away_m = touching_m + Vec3(10.0, 0.0, 0.0) * scene.value()->model.diagonal_m;
    double payload_kb = 0.0;
    std::uint64_t first_wish = 0;
    std::uint64_t first_exact = 0;
    std::uint64_t loads = 0;
    // What a run costs that asks for nothing comes off.
    for (const bool touches : {false, true})
    {
        const std::vector<Vec3> goals_m(kFrames, touches ? touching_m : away_m);
        if (auto written =
                write_motion(context, *scene.value(), goals_m, folder.path() / "motion.rec");
            !written)
        {
            return written.error().text;
        }
        auto place = Place::make(test_case.delay_ms, 0.0, folder.path());
        if (!place)
        {
            return place.error().text;
        }
        const auto host = publish(*scene.value(), place.value().host(), folder.path());
        if (!host)
        {
            return host.error().text;
        }
        const auto report = run_hrtc(*scene.value(), place.value().controller(),
                                     {0.5, kCache_mib, kFrames}, folder.path());
        if (!report)
        {
            return report.error().text;
        }
        const auto traffic = place.value().networks->traffic();
        if (!traffic)
        {
            return traffic.error().text;
        }
        const double all_kb = static_cast<double>(traffic.value().payload_bytes) / kKilo;
        payload_kb = touches ? all_kb - payload_kb : all_kb;
        std::uint64_t frame = 0;
        const CaseFailure failure = look_at_frames(
            folder.path(),
            [&](const FrameOutput& output)
            {
                ++frame;
                loads += output.work.pages_adopted;
                first_wish = first_wish == 0 && output.work.requests > 0 ? frame : first_wish;
                const bool is_exact = touches && output.pairs[0].kind == AnswerKind::exact;
                first_exact = first_exact == 0 && is_exact ? frame : first_exact;
            });
        if (failure)
        {
            return failure;
        }
    }
    Row common = common_row(context, "first touch, cold", *scene.value());
    common.frames = kFrames;
    CaseRows rows(context.rows, common);
    rows.add("UDP payload", payload_kb, "kB", goal_if(test_case.payload_kb));
    rows.add("first wish to exact",
             first_exact == 0 ? std::numeric_limits<double>::quiet_NaN()
                              : static_cast<double>(first_exact - first_wish) * kPeriod_s * kKilo,
             "ms", goal_if(test_case.time_ms));
    rows.add("pieces", static_cast<double>(loads), "");
    return std::nullopt;
}

namespace
{

Result<Program, SceneError> start_client(const std::filesystem::path& folder, std::uint32_t number,
                                         double rate_hz, double seconds)
{
    const std::string name = fmt::format("client-{}", number);
    return Program::start(
        at(loopback_end(), folder / (name + ".log"),
           {program_path("stream_client"), "--model", "model", "--name", name, "--domain", domain(),
            "--rate", fmt::format("{}", rate_hz), "--seconds", fmt::format("{}", seconds)}));
}

/// The client's last line.
Result<Json, SceneError> client_report(Program& client, const std::filesystem::path& output)
{
    if (auto done = client.wait(); !done)
    {
        return done.error();
    }
    std::ifstream file(output);
    std::string line;
    std::string last;
    while (std::getline(file, line))
    {
        last = line;
    }
    return Json::parse(last);
}

double resident_mib(pid_t id)
{
    std::ifstream file(fmt::format("/proc/{}/status", id));
    for (std::string word; file >> word;)
    {
        if (word == "VmRSS:")
        {
            double kib = 0.0;
            file >> kib;
            return kib / 1'024.0;
        }
    }
    return 0.0;
}

} // namespace

CaseFailure run_throughput_case(const CaseContext& context, const ThroughputCase& test_case)
{
    constexpr double kSeconds = 5.0;
    const auto scene = context.scenes.get(test_case.scene);
    if (!scene)
    {
        return scene.error().text;
    }
    const test::TemporaryFolder folder("throughput");
    const auto host = publish(*scene.value(), loopback_end(), folder.path());
    if (!host)
    {
        return host.error().text;
    }
    const double before_mib = resident_mib(host.value().id());
    auto client = start_client(folder.path(), 0, 0.0, kSeconds);
    if (!client)
    {
        return client.error().text;
    }
    const auto report = client_report(client.value(), folder.path() / "client-0.log");
    if (!report)
    {
        return report.error().text;
    }
    CaseRows rows(context.rows, common_row(context, "throughput", *scene.value()));
    const double seconds = report.value()["seconds"].get<double>();
    rows.add("samples", report.value()["link_bytes"].get<double>() * 1e-6 / seconds, "MB/s",
             test_case.mb_per_s)
        .is_least = true;
    rows.add("pieces", report.value()["pieces"].get<double>() / seconds, "/s");
    rows.add("host before", before_mib, "MiB");
    rows.add("host after", resident_mib(host.value().id()), "MiB");
    return std::nullopt;
}

CaseFailure run_fan_out_case(const CaseContext& context, const FanOutCase& test_case)
{
    constexpr double kSeconds = 10.0;
    constexpr double kServedGoal = 95.0; // The last ones are on their way at the end.
    const auto scene = context.scenes.get(test_case.scene);
    if (!scene)
    {
        return scene.error().text;
    }
    const test::TemporaryFolder folder("fan-out");
    const auto host = publish(*scene.value(), loopback_end(), folder.path());
    if (!host)
    {
        return host.error().text;
    }
    CaseRows rows(context.rows, common_row(context, "many controllers", *scene.value()));
    rows.add("clients", test_case.clients, "");
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
            auto client = start_client(folder.path(), i, test_case.rate_hz, kSeconds);
            if (!client)
            {
                return client.error().text;
            }
            clients.push_back(std::move(client).value());
        }
        for (const Program& client : clients)
        {
            if (auto ready = client.wait_for("connected", kStartTimeout); !ready)
            {
                return ready.error().text;
            }
        }
        if (stops_one)
        {
            clients[0].send_signal(SIGSTOP);
        }
        double p99_ms = 0.0;
        double least_share = 1.0;
        for (std::uint32_t i = stops_one ? 1 : 0; i < test_case.clients; ++i)
        {
            const auto report =
                client_report(clients[i], folder.path() / fmt::format("client-{}.log", i));
            if (!report)
            {
                return report.error().text;
            }
            p99_ms = std::max(p99_ms, report.value()["p99_ms"].get<double>());
            least_share = std::min(least_share, report.value()["pieces"].get<double>() /
                                                    (test_case.rate_hz * kSeconds));
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
    rows.add("host", resident_mib(host.value().id()), "MiB");
    return std::nullopt;
}

namespace
{

/// Asks a host for pieces in a thread of its own while it lives.
class Flood
{
public:
    static Result<std::unique_ptr<Flood>, SceneError> begin()
    {
        auto flood = std::make_unique<Flood>();
        ::setenv("CYCLONEDDS_URI", loopback_end().dds_uri.c_str(), 1);
        auto client =
            dds::DdsClient::create(static_cast<std::uint32_t>(std::stoul(domain())), "flood", {});
        if (!client)
        {
            return SceneError{client.error().text};
        }
        flood->client_ = std::move(client).value();
        auto model = flood->client_->find({"model", std::nullopt}, kStartTimeout);
        if (!model)
        {
            return SceneError{model.error().text};
        }
        flood->model_ = std::move(model).value();
        flood->asking_.emplace(flood->model_, 0.0);
        flood->thread_ = std::thread([&self = *flood] { self.asking_->run(1e9, self.stop_); });
        return flood;
    }
    Flood() = default;
    Flood(const Flood&) = delete;
    Flood& operator=(const Flood&) = delete;
    ~Flood()
    {
        stop_ = true;
        if (thread_.joinable())
        {
            thread_.join();
        }
    }
    /// Ends it; what it moved, in MB/s.
    [[nodiscard]] double end()
    {
        stop_ = true;
        thread_.join();
        const Json report = Json::parse(asking_->to_json());
        return report["link_bytes"].get<double>() * 1e-6 / report["seconds"].get<double>();
    }

private:
    std::atomic<bool> stop_{false};
    std::unique_ptr<dds::DdsClient> client_;
    ServedModel model_;
    std::optional<AskingClient> asking_;
    std::thread thread_;
};

} // namespace

CaseFailure run_beside_dds_case(const CaseContext& context, const BesideDdsCase& test_case)
{
    constexpr double kSpeed_diag_per_s = 0.5;
    constexpr std::uint32_t kFrames = 5'000;
    constexpr std::uint32_t kQuickFrames = 500;
    constexpr std::uint32_t kPasses = 5;
    const auto scene = context.scenes.get(test_case.scene);
    if (!scene)
    {
        return scene.error().text;
    }
    const std::uint32_t frames = context.options.frames_or(kFrames, kQuickFrames);
    const FrameRun run = make_slide(*scene.value(), kSpeed_diag_per_s,
                                    tour_splits(kSpeed_diag_per_s), std::size_t{4} << 20U, frames);
    const test::TemporaryFolder folder("beside-dds");
    std::optional<Program> host;
    std::unique_ptr<Flood> flood;
    if (test_case.is_beside)
    {
        auto started = publish(*scene.value(), loopback_end(), folder.path());
        if (!started)
        {
            return started.error().text;
        }
        host.emplace(std::move(started).value());
        auto begun = Flood::begin();
        if (!begun)
        {
            return begun.error().text;
        }
        flood = std::move(begun).value();
    }
    FrameReplay replay(run);
    for (std::uint32_t pass = 0; pass < context.options.passes_or(kPasses, 2); ++pass)
    {
        if (const auto failure = replay.run_once(CacheState::warm, frames))
        {
            return failure;
        }
    }
    Row common = common_row(context, "frames beside DDS", *scene.value());
    common.frames = run.counted();
    common.hash = replay.hash();
    CaseRows rows(context.rows, common);
    const FrameWork& work = replay.work();
    rows.add("splits", static_cast<double>(work.splits), "");
    rows.add("nodes", static_cast<double>(work.nodes), "");
    rows.add("triangles", static_cast<double>(work.triangles), "");
    rows.add("p50", spread_of(replay.sum_us(CacheState::warm).least()).p50, "us");
    rows.add("p99", spread_of(replay.sum_us(CacheState::warm).least()).p99, "us");
    rows.add("DDS", flood == nullptr ? 0.0 : flood->end(), "MB/s");
    return std::nullopt;
}

} // namespace tactus::bench
