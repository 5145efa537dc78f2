// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// stream_client: the transport of a controller without the rest. Requests chunks at a rate, or as
/// fast as they arrive, and prints the times.

#include "platform/program/command_line.hpp"
#include "platform/program/run_program.hpp"
#include "rt_core/spm/header.hpp"
#include "tests/bench/bench_row.hpp"
#include "tests/shared/random.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/served_model.hpp"
#include "transport/waiting_times.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <limits>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

namespace tactus::bench
{
namespace
{

/// Client that requests chunks of a model in its own order, like a controller's transport without
/// the rest. Received chunks are counted, not decoded.
class AskingClient final : private PieceSink
{
public:
    /// Requests `rate_hz` chunks a second; 0: as fast as they arrive. The model must outlive the
    /// client.
    AskingClient(ServedModel& model, double rate_hz);

    /// Runs for `seconds` or until `stop` is set.
    void run(double seconds, const std::atomic<bool>& stop);

    /// Report:
    /// {"pieces","bytes","link_bytes","seconds","asked","asked_again","p50_ms","p99_ms","max_ms"}.
    [[nodiscard]] std::string to_json() const;

private:
    using Clock = std::chrono::steady_clock;
    struct Open
    {
        Clock::time_point first;
        Clock::time_point last;
    };

    void ask(double elapsed_s);
    void ask_again();
    void send();
    void receive(ContentKey key, std::span<const std::byte> bytes) override;

    ChunkLink& link_;
    std::uint32_t chunks_;
    double rate_hz_;
    std::unordered_map<std::uint32_t, Open> open_;
    std::vector<ContentKey> batch_;
    Clock::time_point looked_{};
    WaitingTimes times_;
    std::uint64_t bytes_{0};
    std::uint64_t asked_{0};
    std::uint64_t asked_again_{0};
    std::uint32_t generation_{0};
    double seconds_{0.0};
};

constexpr std::size_t kOpenMax = 256;
constexpr auto kRetry = std::chrono::milliseconds(200);
/// Pauses between two polls. The shortest is that of a controller's transport thread; slow clients
/// take a tenth of the time between two chunks, so that many run on few processors.
constexpr double kPauseMin_s = 300e-6;
constexpr double kPauseMax_s = 10e-3;

AskingClient::AskingClient(ServedModel& model, double rate_hz)
    : link_(*model.link)
    , chunks_(ModelHeader::parse(model.header).value().counts().chunks())
    , rate_hz_(rate_hz)
{
}

void AskingClient::run(double seconds, const std::atomic<bool>& stop)
{
    const auto begin = Clock::now();
    const std::chrono::duration<double> pause(
        rate_hz_ > 0.0 ? std::clamp(0.1 / rate_hz_, kPauseMin_s, kPauseMax_s) : 0.0);
    for (double elapsed_s = 0.0; !stop.load() && elapsed_s < seconds; seconds_ = elapsed_s)
    {
        ask(elapsed_s);
        ask_again();
        link_.poll(*this);
        if (rate_hz_ > 0.0)
        {
            std::this_thread::sleep_for(pause);
        }
        elapsed_s = std::chrono::duration<double>(Clock::now() - begin).count();
    }
}

std::string AskingClient::to_json() const
{
    return nlohmann::json{{"pieces", times_.total()},
                          {"bytes", bytes_},
                          {"link_bytes", link_.bytes_received()},
                          {"seconds", seconds_},
                          {"asked", asked_},
                          {"asked_again", asked_again_},
                          {"p50_ms", times_.quantile_ms(0.5)},
                          {"p99_ms", times_.quantile_ms(0.99)},
                          {"max_ms", times_.longest_ms()}}
        .dump();
}

void AskingClient::ask(double elapsed_s)
{
    const double due =
        rate_hz_ > 0.0 ? rate_hz_ * elapsed_s : std::numeric_limits<double>::infinity();
    const auto now = Clock::now();
    while (open_.size() < kOpenMax && static_cast<double>(asked_) < due)
    {
        const auto chunk = static_cast<std::uint32_t>(test::mixed(kSeed, asked_) % chunks_);
        ++asked_;
        if (open_.emplace(chunk, Open{now, now}).second)
        {
            batch_.push_back({ContentKind::chunk, chunk});
        }
    }
    send();
}

void AskingClient::ask_again()
{
    const auto now = Clock::now();
    if (now - looked_ < kRetry / 4)
    {
        return;
    }
    looked_ = now;
    for (auto& [chunk, open] : open_)
    {
        if (now - open.last >= kRetry)
        {
            open.last = now;
            batch_.push_back({ContentKind::chunk, chunk});
            ++asked_again_;
        }
    }
    send();
}

void AskingClient::send()
{
    if (!batch_.empty())
    {
        link_.request(batch_, ++generation_);
        batch_.clear();
    }
}

void AskingClient::receive(ContentKey key, std::span<const std::byte> bytes)
{
    const auto open = open_.find(key.number);
    if (open == open_.end())
    {
        return;
    }
    const std::chrono::nanoseconds waited = Clock::now() - open->second.first;
    times_.add(waited.count());
    bytes_ += bytes.size();
    open_.erase(open);
}

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
