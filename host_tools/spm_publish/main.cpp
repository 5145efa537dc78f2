// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/cli/command_line.hpp"
#include "host_tools/spm_publish/serving_report.hpp"
#include "transport/content_hash.hpp"
#include "transport/dds/dds_host.hpp"
#include "transport/model_name.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <exception>
#include <filesystem>
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

void declare_options(CLI::App& app, Options& options)
{
    app.set_version_flag("--version", std::string("spm_publish ") + TACTUS_VERSION);
    app.add_option("FILE", options.files, "Models to serve (.spm)")->required();
    app.add_option("--name", options.names,
                   "Name of the first model, of the second, ...; without it the file's stem")
        ->expected(1)
        ->take_all();
    app.add_option("--domain", options.domain, "DDS domain")
        ->check(CLI::Range(std::uint32_t{0}, dds::kMaxDomain))
        ->capture_default_str();
    app.add_option("--seconds", options.seconds, "End by itself after this long")
        ->check(number_between(0.1, 1e9));
}

/// The models' names in the order of the files; a line when one is missing, wrong or there twice.
Result<std::vector<std::string>, NameError> choose_names(const Options& options)
{
    if (options.names.size() > options.files.size())
    {
        return NameError{fmt::format("--name is given {} times for {} files", options.names.size(),
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
            return NameError{fmt::format("{} '{}' is not 1 to 63 characters of A-Z a-z 0-9 . _ -{}",
                                         is_given ? "--name" : "the stem of '" + file + "',",
                                         printable(name),
                                         is_given ? "" : "; give one with --name")};
        }
        for (std::size_t other = 0; other < i; ++other)
        {
            if (names[other] == name)
            {
                return NameError{fmt::format("'{}' and '{}' would both be published as '{}'; give "
                                             "them different names with --name",
                                             options.files[other], file, name)};
            }
        }
        names.push_back(name);
    }
    return names;
}

Result<std::vector<dds::PublishedModel>, StoreError>
open_models(const Options& options, const std::vector<std::string>& names)
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

void serve(dds::DdsHost& host, ServingReport& report, const std::optional<double>& seconds)
{
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    const auto is_over = [&]
    { return seconds && std::chrono::duration<double>(Clock::now() - start).count() >= *seconds; };
    while (!stop_requested.load(std::memory_order_relaxed) && !is_over())
    {
        host.wait(std::chrono::milliseconds(50));
        host.step();
        report.update(host);
    }
}

int run(int argc, char** argv)
{
    CLI::App app("Serves SPM models to controllers over DDS.", "spm_publish");
    Options options;
    declare_options(app, options);
    if (const auto code = parse_command_line(app, argc, argv))
    {
        return *code;
    }
    const auto names = choose_names(options);
    if (!names)
    {
        return fail(app, names.error().text, kExitUsage);
    }
    auto models = open_models(options, names.value());
    if (!models)
    {
        return fail(app, models.error().text);
    }
    stop_on_signals();
    ServingReport report;
    auto host =
        dds::DdsHost::create(options.domain, std::move(models).value(),
                             [&report](const std::string& line) { report.print_line(line); });
    if (!host)
    {
        return fail(app, host.error().text);
    }
    print_models(report, *host.value(), options.domain);
    serve(*host.value(), report, options.seconds);
    const auto counters = host.value()->counters();
    report.print_line(fmt::format("ended; {} chunks, {:.1f} KB sent", counters.pieces_sent,
                                  static_cast<double>(counters.bytes_sent) / 1e3));
    return kExitDone;
}

} // namespace

} // namespace tactus

int main(int argc, char** argv)
{
    try
    {
        return tactus::run(argc, argv);
    }
    catch (const std::exception& error)
    {
        fmt::print(stderr, "spm_publish: {}\n", error.what());
    }
    return tactus::kExitFailed;
}
