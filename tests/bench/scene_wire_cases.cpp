// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Cost of a model server's objects on the wire and for joining controllers, between processes on a
/// separate loopback network.

#include "host_tools/shapes/shapes.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/program.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/bench/suites.hpp"
#include "transport/dds/dds_server.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <net/if.h>
#include <sched.h>
#include <string>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

namespace tactus::bench
{
namespace
{

/// Model server in its own thread, which shows objects and moves some of them 100 times a second.
class ShowingServer
{
public:
    /// Serves these files as "model-0" and so on; the objects in the scene "bench" show them in
    /// turn.
    [[nodiscard]] static std::unique_ptr<ShowingServer>
    start(std::uint32_t domain, const std::vector<std::filesystem::path>& files,
          std::uint32_t objects);
    ~ShowingServer();
    ShowingServer(const ShowingServer&) = delete;
    ShowingServer& operator=(const ShowingServer&) = delete;

    /// Number of objects that move from now on, the first ones.
    void move(std::uint32_t objects) { moving_ = objects; }

private:
    explicit ShowingServer(std::unique_ptr<dds::DdsServer> server) : server_(std::move(server)) {}
    void run();

    std::unique_ptr<dds::DdsServer> server_;
    std::atomic<std::uint32_t> moving_{0};
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

/// Moves this process and its future children to a network namespace with a loopback interface
/// only. The caller must have no other threads. A failure if the system does not permit it.
void enter_own_network()
{
    const auto refuse = [](const char* what)
    { throw Failure(fmt::format("no network of its own: {}: {}", what, std::strerror(errno))); };
    if (::unshare(CLONE_NEWNET) != 0)
    {
        refuse("unshare");
    }
    const int any = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    ifreq loopback{};
    std::strcpy(loopback.ifr_name, "lo");
    const bool is_read = any >= 0 && ::ioctl(any, SIOCGIFFLAGS, &loopback) == 0;
    loopback.ifr_flags = static_cast<short>(loopback.ifr_flags | IFF_UP);
    const bool is_up = is_read && ::ioctl(any, SIOCSIFFLAGS, &loopback) == 0;
    ::close(any);
    if (!is_up)
    {
        refuse("loopback");
    }
}

/// Bytes sent over it so far: each datagram once, with its headers.
std::uint64_t loopback_bytes()
{
    std::ifstream file("/proc/self/net/dev");
    std::uint64_t bytes = 0;
    for (std::string word; file >> word;)
    {
        if (word == "lo:")
        {
            file >> bytes;
            break;
        }
    }
    return bytes;
}

constexpr std::chrono::milliseconds kMoveEvery{10};
constexpr double kStep_m = 0.001; ///< 0.1 m/s.

/// Grid position.
Pose place_of(std::uint32_t object)
{
    Pose pose;
    pose.translation_m = {0.2 * (object % 16), 0.2 * (object / 16 % 16), 0.2 * (object / 256)};
    return pose;
}

std::unique_ptr<ShowingServer> ShowingServer::start(std::uint32_t domain,
                                                    const std::vector<std::filesystem::path>& files,
                                                    std::uint32_t objects)
{
    std::vector<dds::PublishedModel> models;
    for (const std::filesystem::path& file : files)
    {
        auto store = needed(ModelStore::open(file));
        models.push_back({fmt::format("model-{}", models.size()), std::move(store)});
    }
    auto made = needed(dds::DdsServer::create(domain, std::move(models), {}, "bench"));
    std::unique_ptr<ShowingServer> showing(new ShowingServer(std::move(made)));
    dds::DdsServer& server = *showing->server_;
    for (std::uint32_t i = 0; i < objects; ++i)
    {
        ShownObject object;
        object.name = fmt::format("object-{}", i);
        object.model = server.models()[i % server.models().size()].store().hash();
        object.pose = place_of(i);
        needed(server.objects().show(object));
    }
    showing->thread_ = std::thread([&self = *showing] { self.run(); });
    return showing;
}

ShowingServer::~ShowingServer()
{
    stop_ = true;
    if (thread_.joinable())
    {
        thread_.join();
    }
}

void ShowingServer::run()
{
    using Clock = std::chrono::steady_clock;
    auto due = Clock::now();
    std::uint32_t steps = 0;
    while (!stop_)
    {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(due - Clock::now());
        server_->wait(std::max(left, std::chrono::milliseconds(0)));
        if (Clock::now() >= due)
        {
            due += kMoveEvery;
            ++steps;
            const std::uint32_t moving = moving_;
            for (std::uint32_t i = 0; i < moving; ++i)
            {
                Pose pose = place_of(i);
                pose.translation_m[2] += kStep_m * (steps % 100);
                static_cast<void>(server_->objects().move(i, pose));
            }
        }
        server_->step();
    }
}

using Json = nlohmann::json;
using Files = std::vector<std::filesystem::path>;
using namespace std::chrono_literals;

constexpr std::uint32_t kDomain = 1;
constexpr std::uint32_t kObjects = 4'096;
constexpr std::uint32_t kMoving = 100;
constexpr std::uint32_t kJoiners = 64;
constexpr std::uint32_t kModels = 256;
constexpr std::chrono::seconds kJoinTimeout{60};

/// Controllers that start together and stay.
class Joiners
{
public:
    /// Returns when each controller has the data that its arguments request.
    static Joiners join(const std::filesystem::path& folder, const std::string& name,
                        std::uint32_t count, const std::vector<std::string>& arguments)
    {
        constexpr auto kStartOfOne = 25ms;
        Joiners joiners;
        const auto at = BenchClock::now() + 500ms + count * kStartOfOne;
        const auto log = [&](std::uint32_t i)
        { return folder / fmt::format("{}-{}.log", name, i); };
        for (std::uint32_t i = 0; i < count; ++i)
        {
            ProgramSetup setup;
            setup.words = {program_path("scene_joiner"),
                           "--domain",
                           fmt::format("{}", kDomain),
                           "--name",
                           fmt::format("{}-{}", name, i),
                           "--at",
                           fmt::format("{}", at.time_since_epoch().count())};
            setup.words.insert(setup.words.end(), arguments.begin(), arguments.end());
            setup.output = log(i);
            joiners.programs_.push_back(Program::start(setup));
        }
        std::this_thread::sleep_until(at);
        const std::uint64_t bytes_before = loopback_bytes();
        for (std::uint32_t i = 0; i < count; ++i)
        {
            joiners.programs_[i].wait_for("}", kJoinTimeout);
            joiners.longest_ms_ =
                std::max(joiners.longest_ms_, report_in(log(i))["ms"].get<double>());
        }
        joiners.bytes_ = static_cast<double>(loopback_bytes() - bytes_before);
        return joiners;
    }

    [[nodiscard]] double longest_ms() const { return longest_ms_; }
    /// Bytes sent over the network meanwhile.
    [[nodiscard]] double bytes() const { return bytes_; }

private:
    std::vector<Program> programs_;
    double longest_ms_{0.0};
    double bytes_{0.0};
};

double kilobytes_per_s()
{
    constexpr auto kTime = 4s; // Five rounds of discovery.
    const std::uint64_t before = loopback_bytes();
    const auto begin = BenchClock::now();
    std::this_thread::sleep_for(kTime);
    return 1e-3 * static_cast<double>(loopback_bytes() - before) /
           seconds(begin, BenchClock::now());
}

std::vector<std::string> all_objects()
{
    return {"--objects", fmt::format("{}", kObjects)};
}

/// Body of a case, in its own process: returns its figures as JSON.
using Measure = Json (*)(ShowingServer& server, const std::filesystem::path& folder);

std::string measured(const Files& files, const std::filesystem::path& folder, std::uint32_t objects,
                     Measure measure)
{
    enter_own_network();
    ::unsetenv("CYCLONEDDS_URI"); // The environment is that of the programs.
    auto server = ShowingServer::start(kDomain, files, objects);
    return measure(*server, folder).dump();
}

/// Scene of at least `faces` faces, each slightly larger than the one before.
const Scene& wire_scene(const CaseContext& context, std::uint32_t number, std::uint32_t faces)
{
    return context.scenes.get(
        {fmt::format("wire-{}-{}", faces, number),
         scaled(make_shape(Shape::bumpy_sphere, faces).value(), 1.0 + 1e-3 * number)});
}

struct WireCase
{
    std::uint32_t models;
    std::uint32_t objects;
    Measure measure;
    /// Row of a figure, with its goal.
    struct Figure
    {
        const char* key;
        const char* unit;
        double goal{kNoGoal};
    };
    std::vector<Figure> figures;
};

void run_wire_case(const CaseContext& context, const WireCase& test_case)
{
    Files files;
    for (std::uint32_t i = 0; i < test_case.models; ++i)
    {
        const Scene& scene = wire_scene(context, i, 1'000);
        files.push_back(scene.model.path);
    }
    const test::TemporaryFolder folder("scene-wire");
    const auto outcome = run_in_child(
        [&] { return measured(files, folder.path(), test_case.objects, test_case.measure); });
    const Json told = Json::parse(outcome.text);
    CaseRows rows(context.rows, context.common_row("bumpy-sphere-1000", "wire"));
    for (const WireCase::Figure& figure : test_case.figures)
    {
        rows.add(figure.key, told[figure.key].get<double>(), figure.unit, goal_if(figure.goal));
    }
}

constexpr const char* kLateJoin = "late join";
constexpr const char* kObjectAtStart = "an object at the join";
constexpr const char* kAlone = "at rest, a server alone";
constexpr const char* kAtRest = "at rest";
constexpr const char* kInMotion = "100 moving at 100 Hz";

Json measure_flow(ShowingServer& server, const std::filesystem::path& folder)
{
    Json told;
    told[kAlone] = kilobytes_per_s();
    const auto late = Joiners::join(folder, "late", 1, all_objects());
    told[kLateJoin] = late.longest_ms();
    told[kObjectAtStart] = late.bytes() / kObjects;
    std::this_thread::sleep_for(1s);
    told[kAtRest] = kilobytes_per_s();
    server.move(kMoving);
    std::this_thread::sleep_for(1s);
    told[kInMotion] = kilobytes_per_s();
    return told;
}

constexpr const char* kTogether = "64 join at once";
constexpr const char* kBytes = "bytes by those of 64 single joins";
constexpr const char* kLoaded = "64 join at once, 100 moving";

Json measure_joins(ShowingServer& server, const std::filesystem::path& folder)
{
    Json told;
    const double single_bytes = Joiners::join(folder, "single", 1, all_objects()).bytes();
    for (const bool moves : {false, true})
    {
        std::this_thread::sleep_for(2s); // Killed processes are gone by then.
        server.move(moves ? kMoving : 0);
        const auto all = Joiners::join(folder, moves ? "loaded" : "all", kJoiners, all_objects());
        told[moves ? kLoaded : kTogether] = all.longest_ms() * 1e-3;
        if (!moves)
        {
            told[kBytes] = all.bytes() / (kJoiners * single_bytes);
        }
    }
    return told;
}

constexpr const char* kStart = "start with 256 models";
constexpr const char* kFarModel = "a far model at the start";
constexpr const char* kLoop = "hrtc with 256 streamed models, until its loop begins";
constexpr const char* kWhole = "hrtc with 256 whole models, until its loop begins";

/// Time from the program's start to its line about objects, in ms.
double start_of_hrtc(const std::filesystem::path& folder, const std::vector<std::string>& arguments)
{
    ProgramSetup setup;
    setup.words = {program_path("hrtc"),       "--allow-no-rt", "--domain",
                   fmt::format("{}", kDomain), "--duration",    "1"};
    setup.words.insert(setup.words.end(), arguments.begin(), arguments.end());
    // A new file for each count.
    setup.output = folder / fmt::format("hrtc-{}.log", arguments.size());
    const auto begin = BenchClock::now();
    auto started = Program::start(setup);
    started.wait_for("touches", kJoinTimeout);
    const double ms = 1e3 * seconds(begin, BenchClock::now());
    started.wait();
    return ms;
}

Json measure_start(ShowingServer& /*server*/, const std::filesystem::path& folder)
{
    const auto one = Joiners::join(folder, "start", 1, {"--models", fmt::format("{}", kModels)});
    const auto loop = start_of_hrtc(folder, {"--scene", "bench", "--pool-mib", "8"});
    std::vector<std::string> all{"--pool-mib", "64"};
    for (std::uint32_t i = 0; i < kModels; ++i)
    {
        all.insert(all.end(), {"--model", fmt::format("model-{}", i)});
    }
    const auto whole = start_of_hrtc(folder, all);
    return Json{{kStart, one.longest_ms()},
                {kFarModel, one.bytes() / kModels},
                {kLoop, loop},
                {kWhole, whole}};
}

struct StreamedModelCase
{
    std::uint32_t models;
    std::uint32_t objects;
    std::uint32_t visits; ///< Objects visited, in turn.
    const char* pool_mib;
};

/// Writes a scene file of small objects on a grid, which show the files in turn.
std::filesystem::path write_scene(const Files& files, double diagonal_m, std::uint32_t objects,
                                  const std::filesystem::path& folder)
{
    constexpr double kSize_m = 0.08;
    constexpr double kApart_m = 0.15;
    for (std::size_t i = 0; i < files.size(); ++i)
    {
        std::filesystem::create_symlink(files[i], folder / fmt::format("model-{}.spm", i));
    }
    Json scene{{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {}}}}}};
    for (std::uint32_t i = 0; i < objects; ++i)
    {
        const double scale = kSize_m / diagonal_m;
        const std::string model = fmt::format("model-{}.spm", i % files.size());
        scene["scenes"][0]["nodes"].push_back(i);
        scene["nodes"].push_back({{"name", fmt::format("object-{}", i)},
                                  {"translation", {kApart_m * (i % 15), kApart_m * (i / 15), 0.0}},
                                  {"scale", {scale, scale, scale}},
                                  {"extras", {{"tactus", {{"model", model}}}}}});
    }
    const std::filesystem::path path = folder / "scene.gltf";
    std::ofstream(path) << scene.dump();
    return path;
}

/// A device moves at 2 m/s with 20 ms delay, in pools that do not hold all models.
void run_streamed_model_case(const CaseContext& context, const StreamedModelCase& test_case)
{
    Files files;
    double diagonal_m = 0.0;
    for (std::uint32_t i = 0; i < test_case.models; ++i)
    {
        const Scene& scene = wire_scene(context, i, 2'000);
        files.push_back(scene.model.path);
        diagonal_m = scene.model.diagonal_m;
    }
    const test::TemporaryFolder folder("scene-streamed-models");
    const auto path = write_scene(files, diagonal_m, test_case.objects, folder.path());
    auto networks = RelayedNetworks::make({10.0}, folder.path());
    auto server = start_at(networks.server(), "spm_publish", folder.path(),
                           {path.string(), "--scene", "bench"});
    server.wait_for("ready on DDS domain", kStartTimeout);
    auto rider = start_at(networks.controller(), "scene_rider", folder.path(),
                          {"--scene", "bench", "--pool-mib", test_case.pool_mib, "--visits",
                           fmt::format("{}", test_case.visits)});
    rider.wait();
    const Json told = report_in(folder.path() / "scene_rider.log");
    if (told["touched"] != told["visits"] || told["streamed_models"] == 0)
    {
        throw Failure("not every object was touched, or all models are here: " + told.dump());
    }
    Row common = context.common_row("bumpy-sphere-2000", "streamed_models");
    common.setting = fmt::format("{} MiB", test_case.pool_mib);
    CaseRows rows(context.rows, common);
    rows.add("start", told["start_ms"].get<double>(), "ms", 500.0);
    rows.add("invisible wall frames, 2 m/s, 20 ms", told["invisible_wall_frames"].get<double>(), "",
             0.0);
    rows.add("wanted to resident, max", told["came_ms_max"].get<double>(), "ms");
    rows.add("base meshes that came", told["came"].get<double>(), "");
    rows.add("models here at once", told["here_max"].get<double>(), "");
}

} // namespace

std::vector<Case> scene_wire_cases()
{
    const auto wire = [](const char* name, const WireCase& test_case)
    { return make_case(name, When::full_only, run_wire_case, test_case); };
    return {
        wire("wire, 4096 objects", {1,
                                    kObjects,
                                    measure_flow,
                                    {{kLateJoin, "ms", 500.0},
                                     {kObjectAtStart, "B", 256.0},
                                     {kAlone, "KB/s"},
                                     {kAtRest, "KB/s", 20.0},
                                     {kInMotion, "KB/s", 1'000.0}}}),
        wire("wire, 64 controllers", {1,
                                      kObjects,
                                      measure_joins,
                                      {{kTogether, "s", 5.0}, {kBytes, "", 2.0}, {kLoaded, "s"}}}),
        wire("wire, 256 models",
             {kModels,
              kModels,
              measure_start,
              {{kStart, "ms", 500.0}, {kFarModel, "B"}, {kLoop, "ms", 500.0}, {kWhole, "ms"}}}),
        make_case("streamed models, 200 objects of 200 models", When::full_only,
                  run_streamed_model_case, StreamedModelCase{200, 200, 60, "8"}),
    };
}

} // namespace tactus::bench
