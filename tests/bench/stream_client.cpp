// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// stream_client: the transport of a controller without the rest. Requests chunks at a rate, or as
/// fast as they arrive, and prints the times.

#include "platform/program/command_line.hpp"
#include "platform/program/run_program.hpp"
#include "tests/bench/asking_client.hpp"
#include "transport/dds/dds_client.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <csignal>

namespace tactus::bench
{
namespace
{

constexpr auto kFindTimeout = std::chrono::seconds(60);

struct Options
{
    std::string model;
    std::string name{"client"};
    std::uint32_t domain{0};
    double rate_hz{0.0}; ///< Rate; 0: as fast as chunks arrive.
    double seconds{5.0};
};

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

int run(int argc, char** argv)
{
    CommandLine line("stream_client",
                     "Asks a server for chunks and tells how long they took, as JSON.");
    Options options;
    line.add_option("--model", options.model, "NAME[@HASH]").required();
    line.add_option("--name", options.name, "Its own, for the server").show_default();
    line.add_option("--domain", options.domain, "DDS domain id").integer_between(0, 232);
    line.add_option("--rate", options.rate_hz, "Chunks a second; 0: as fast as they come")
        .number_between(0.0, 1e6);
    line.add_option("--seconds", options.seconds, "How long").number_between(0.1, 86'400.0);
    if (const std::optional<int> code = line.parse(argc, argv))
    {
        return *code;
    }
    const auto selector = parse_selector(options.model);
    if (!selector || !is_valid_name(options.name))
    {
        return line.fail("--model, --name: at most 63 of [A-Za-z0-9._-], @ and 32 hexadecimal "
                         "digits after a model's",
                         kExitUsage);
    }
    std::signal(SIGTERM, [](int) { stop_requested = true; });
    auto client = dds::DdsClient::create(options.domain, options.name, {});
    if (!client)
    {
        return line.fail(client.error().text);
    }
    auto model =
        client.value()->find(selector.value(), kFindTimeout, [] { return !stop_requested; });
    if (!model)
    {
        return line.fail(model.error().text);
    }
    fmt::print(stderr, "connected\n");
    AskingClient asking(model.value(), options.rate_hz);
    asking.run(options.seconds, stop_requested);
    fmt::print("{}\n", asking.to_json());
    return kExitDone;
}

} // namespace
} // namespace tactus::bench

int main(int argc, char** argv)
{
    return tactus::run_program("stream_client", "", [&] { return tactus::bench::run(argc, argv); });
}
