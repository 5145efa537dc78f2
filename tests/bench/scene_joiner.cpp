// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// scene_joiner: obtains a model server's objects or models as a controller does, without the rest
/// of one. Prints the time it took, and stays until told to end.

#include "platform/program/command_line.hpp"
#include "platform/program/run_program.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/dds/scene_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace tactus::bench
{
namespace
{

/// Pause between two polls: longer than that of a controller's transport thread, so that many run
/// on few processors.
constexpr auto kPause = std::chrono::milliseconds(5);

struct Options
{
    std::string name{"joiner"};
    std::uint32_t domain{0};
    std::uint32_t objects{0};
    std::uint32_t models{0};
    std::int64_t at_ns{0};
};

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void tell(double ms)
{
    fmt::print("{{\"ms\": {:.3f}}}\n", ms);
    std::fflush(stdout);
}

int run(int argc, char** argv)
{
    using Clock = std::chrono::steady_clock;
    CommandLine line("scene_joiner", "Joins a server and tells how long that took, as JSON.");
    Options options;
    line.add_option("--name", options.name, "Its own, for the server").show_default();
    line.add_option("--domain", options.domain, "DDS domain id").integer_between(0, 232);
    line.add_option("--objects", options.objects, "How many there are to have");
    line.add_option("--models", options.models, "Instead: headers of so many, model-0 and so on");
    line.add_option("--at", options.at_ns, "When to begin, on the monotonic clock, in ns");
    if (const std::optional<int> code = line.parse(argc, argv))
    {
        return *code;
    }
    if (!is_valid_name(options.name))
    {
        return line.fail("--name: at most 63 of [A-Za-z0-9._-]", kExitUsage);
    }
    std::signal(SIGTERM, [](int) { stop_requested = true; });
    std::this_thread::sleep_until(Clock::time_point(std::chrono::nanoseconds(options.at_ns)));
    const auto begin = Clock::now();
    const auto since_begin_ms = [begin]
    { return std::chrono::duration<double, std::milli>(Clock::now() - begin).count(); };
    auto client = dds::DdsClient::create(options.domain, options.name, {});
    if (!client)
    {
        return line.fail(client.error().text);
    }
    if (options.models > 0)
    {
        std::vector<ModelSelector> selectors;
        for (std::uint32_t i = 0; i < options.models; ++i)
        {
            selectors.push_back({fmt::format("model-{}", i), std::nullopt});
        }
        const auto models = client.value()->find_headers(selectors, std::chrono::seconds(60));
        if (!models)
        {
            return line.fail(models.error().text);
        }
        tell(since_begin_ms());
        return kExitDone;
    }
    dds::PieceExchange& exchange = client.value()->exchange();
    dds::SceneReader scene(client.value()->domain(), exchange);
    bool is_told = false;
    std::array<std::uint64_t, 1> server{};
    while (!stop_requested)
    {
        exchange.step();
        const auto* offer = client.value()->catalogue().find({"model-0", std::nullopt});
        if (offer != nullptr)
        {
            server[0] = offer->server_epoch;
            scene.poll(server, [](dds::SceneNews, const dds::SeenObject&) {});
        }
        if (!is_told && scene.objects(server[0]).size() == options.objects)
        {
            is_told = true;
            tell(since_begin_ms());
        }
        std::this_thread::sleep_for(kPause);
    }
    return kExitDone;
}

} // namespace
} // namespace tactus::bench

int main(int argc, char** argv)
{
    return tactus::run_program("scene_joiner", "", [&] { return tactus::bench::run(argc, argv); });
}
