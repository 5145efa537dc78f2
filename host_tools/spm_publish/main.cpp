// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/cli/command_line.hpp"
#include "host_tools/cli/run_program.hpp"
#include "host_tools/spm_publish/pose_script.hpp"
#include "host_tools/spm_publish/serving_report.hpp"
#include "host_tools/spm_publish/watch.hpp"
#include "platform/base/printable.hpp"
#include "platform/base/refusal.hpp"
#include "transport/content_hash.hpp"
#include "transport/dds/dds_host.hpp"
#include "transport/dds/poses.hpp"
#include "transport/dds/telemetry.hpp"
#include "transport/model_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus
{

namespace
{

struct Options
{
    std::vector<std::string> files;
    std::vector<std::string> names;
    std::uint32_t domain{0};
    std::optional<double> seconds;
    std::string poses_path; ///< Empty: nothing moves.
    bool poses_loop{false};
    bool watch{false};
};

/// What a host does besides serving; each may be none.
struct Extras
{
    std::unique_ptr<dds::PosePublisher> publisher;
    std::optional<PosePlayer> player;
    std::optional<Watch> watch;
};

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free); // Set in a signal handler.

void stop_on_signals()
{
    struct sigaction action = {};
    action.sa_handler = [](int) { stop_requested.store(true, std::memory_order_relaxed); };
    ::sigaction(SIGINT, &action, nullptr);
    ::sigaction(SIGTERM, &action, nullptr);
}

void declare_options(CommandLine& line, Options& options)
{
    line.add_version(std::string("spm_publish ") + TACTUS_VERSION);
    line.add_option("FILE", options.files, "Models to serve (.spm)").required();
    line.add_option("--name", options.names,
                    "Name of the first model, of the second, ...; without it the file's stem")
        .repeatable_with_more();
    line.add_option("--domain", options.domain, "DDS domain")
        .integer_between(std::uint32_t{0}, dds::kMaxDomain)
        .show_default();
    line.add_option("--seconds", options.seconds, "End by itself after this long")
        .number_between(0.1, 1e9);
    line.add_option("--poses", options.poses_path,
                    fmt::format("Move the models as this text file says, in real time: lines {} in "
                                "order of time, in s and m, with the published name and a unit "
                                "quaternion; # begins a comment",
                                kPoseLineForm));
    line.add_flag("--poses-loop", options.poses_loop,
                  "Begin the file anew at the time of its last line, again and again");
    line.add_flag("--watch", options.watch,
                  "Print what each controller on the domain does, a line a second");
}

/// The models' names in the order of the files; a line when one is missing, wrong or there twice.
Result<std::vector<std::string>, Refusal> choose_names(const Options& options)
{
    if (options.names.size() > options.files.size())
    {
        return Refusal{fmt::format("--name is given {} times for {} files", options.names.size(),
                                   options.files.size())};
    }
    std::vector<std::string> names;
    for (std::size_t i = 0; i < options.files.size(); ++i)
    {
        const std::string& file = options.files[i];
        const bool is_given = i < options.names.size();
        const std::string name =
            is_given ? options.names[i] : std::filesystem::path(file).stem().string();
        if (!is_valid_name(name))
        {
            return Refusal{fmt::format("{} '{}' is not 1 to 63 characters of A-Z a-z 0-9 . _ -{}",
                                       is_given ? "--name" : "the stem of '" + file + "',",
                                       printable(name), is_given ? "" : "; give one with --name")};
        }
        for (std::size_t other = 0; other < i; ++other)
        {
            if (names[other] == name)
            {
                return Refusal{fmt::format("'{}' and '{}' would both be published as '{}'; give "
                                           "them different names with --name",
                                           options.files[other], file, name)};
            }
        }
        names.push_back(name);
    }
    return names;
}

Result<std::vector<dds::PublishedModel>, Refusal> open_models(const Options& options,
                                                              const std::vector<std::string>& names)
{
    std::vector<dds::PublishedModel> models;
    for (std::size_t i = 0; i < names.size(); ++i)
    {
        auto store = ModelStore::open(options.files[i]);
        if (!store)
        {
            return store.error();
        }
        models.push_back({names[i], std::move(store).value()});
    }
    return models;
}

void print_models(ServingReport& report, const dds::DdsHost& host, std::uint32_t domain)
{
    for (const dds::PublishedModel& model : host.models())
    {
        const HeaderFields& fields = model.store.header().fields();
        report.print_line(fmt::format("serving '{}' hash {}: {} faces, {} bytes, from {}",
                                      model.name, hash_text(model.store.hash()),
                                      fields.source_faces, fields.file_bytes,
                                      model.store.path().string()));
    }
    report.print_line(fmt::format("ready on DDS domain {}; end with Ctrl-C", domain));
}

/// Nothing when no pose file is given.
Result<std::vector<PoseLine>, Refusal> read_poses(const Options& options,
                                                  const std::vector<std::string>& names)
{
    if (options.poses_path.empty())
    {
        return std::vector<PoseLine>{};
    }
    auto lines = read_pose_file(options.poses_path, names);
    if (lines && options.poses_loop && lines.value().back().time_s == 0.0)
    {
        return Refusal{options.poses_path + ": --poses-loop needs a last line with a time "
                                            "above 0 s"};
    }
    return lines;
}

Result<Extras, Refusal> make_extras(const Options& options, const dds::DdsHost& host,
                                    std::vector<PoseLine> lines)
{
    Extras extras;
    if (!lines.empty())
    {
        std::vector<ModelIdentity> objects;
        for (const dds::PublishedModel& model : host.models())
        {
            objects.push_back({model.name, model.store.hash(), model.store.revision()});
        }
        extras.player.emplace(std::move(lines), objects.size(), options.poses_loop);
        auto publisher =
            dds::PosePublisher::create(host.domain(), host.epoch(), std::move(objects));
        if (!publisher)
        {
            return publisher.error();
        }
        extras.publisher = std::move(publisher).value();
    }
    if (options.watch)
    {
        auto reader = dds::TelemetryReader::create(host.domain());
        if (!reader)
        {
            return reader.error();
        }
        extras.watch.emplace(std::move(reader).value());
    }
    return extras;
}

/// How long the host may wait: until a pose is due.
std::chrono::milliseconds longest_wait(const Extras& extras, double now_s)
{
    constexpr std::chrono::milliseconds least{1};
    if (!extras.player)
    {
        return std::chrono::milliseconds(50);
    }
    const std::chrono::milliseconds most = dds::kPoseRepeat / 2;
    const double left_s = extras.player->next_s().value_or(now_s + 1.0) - now_s;
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        std::chrono::duration<double>(std::clamp(left_s, 0.0, 1.0)));
    return std::clamp(left, least, most);
}

void play(Extras& extras, double now_s)
{
    for (const PoseLine& line : extras.player->take_due(now_s))
    {
        const auto moved = extras.publisher->move(line.object, line.pose);
        TACTUS_ASSERT(moved.has_value()); // The file was checked.
    }
    extras.publisher->repeat();
}

void serve(dds::DdsHost& host, ServingReport& report, Extras& extras,
           const std::optional<double>& seconds)
{
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    const auto now_s = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
    while (!stop_requested.load(std::memory_order_relaxed) && !(seconds && now_s() >= *seconds))
    {
        host.wait(longest_wait(extras, now_s()));
        host.step();
        if (extras.player)
        {
            play(extras, now_s());
        }
        if (extras.watch)
        {
            extras.watch->update(report);
        }
        report.update(host);
    }
}

int run(int argc, char** argv)
{
    CommandLine line("spm_publish", "Serves SPM models to controllers over DDS.");
    Options options;
    declare_options(line, options);
    if (const auto code = line.parse(argc, argv))
    {
        return *code;
    }
    const auto names = choose_names(options);
    if (!names)
    {
        return line.fail(names.error().text, kExitUsage);
    }
    if (options.poses_loop && options.poses_path.empty())
    {
        return line.fail("--poses-loop: needs --poses", kExitUsage);
    }
    auto models = open_models(options, names.value());
    if (!models)
    {
        return line.fail(models.error().text);
    }
    auto poses = read_poses(options, names.value());
    if (!poses)
    {
        return line.fail(poses.error().text);
    }
    stop_on_signals();
    ServingReport report;
    auto host =
        dds::DdsHost::create(options.domain, std::move(models).value(),
                             [&report](const std::string& text) { report.print_line(text); });
    if (!host)
    {
        return line.fail(host.error().text);
    }
    auto extras = make_extras(options, *host.value(), std::move(poses).value());
    if (!extras)
    {
        return line.fail(extras.error().text);
    }
    print_models(report, *host.value(), options.domain);
    serve(*host.value(), report, extras.value(), options.seconds);
    const auto counters = host.value()->counters();
    report.print_line(fmt::format("ended; {} chunks, {:.1f} KB sent", counters.pieces_sent,
                                  static_cast<double>(counters.bytes_sent) / 1e3));
    return kExitDone;
}

} // namespace

} // namespace tactus

int main(int argc, char** argv)
{
    return tactus::run_program("spm_publish", "", [&] { return tactus::run(argc, argv); });
}
