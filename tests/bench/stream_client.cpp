// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// stream_client: the transport of a controller without the rest of it. Asks a host for chunks at a
/// rate, or as fast as they come, and tells how long they took.

#include "host_tools/cli/command_line.hpp"
#include "rt_core/spm/header.hpp"
#include "tests/bench/random.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/waiting_times.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <exception>
#include <thread>
#include <unordered_map>

namespace tactus::bench
{
namespace
{

using Clock = std::chrono::steady_clock;

constexpr std::size_t kOpenMax = 256;
constexpr auto kRetry = std::chrono::milliseconds(200);
constexpr auto kFindTimeout = std::chrono::seconds(60);
constexpr auto kPause = std::chrono::microseconds(300);

struct Options
{
    std::string model;
    std::string name{"client"};
    std::uint32_t domain{0};
    double rate_hz{0.0}; ///< 0: as fast as they come.
    double seconds{5.0};
};

volatile std::sig_atomic_t stop_requested = 0;

class Client final : private PieceSink
{
public:
    Client(ServedModel& model, double rate_hz)
        : link_(*model.link)
        , chunks_(ModelHeader::parse(model.header).value().counts().chunks())
        , rate_hz_(rate_hz)
    {
    }

    void run(double seconds)
    {
        const auto begin = Clock::now();
        while (stop_requested == 0 && elapsed_s(begin) < seconds)
        {
            ask(begin);
            ask_again();
            link_.poll(*this);
            if (rate_hz_ > 0.0)
            {
                std::this_thread::sleep_for(kPause);
            }
        }
        seconds_ = elapsed_s(begin);
    }

    [[nodiscard]] std::string to_json() const
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

private:
    struct Open
    {
        Clock::time_point first;
        Clock::time_point last;
    };

    [[nodiscard]] static double elapsed_s(Clock::time_point begin)
    {
        return std::chrono::duration<double>(Clock::now() - begin).count();
    }

    void ask(Clock::time_point begin)
    {
        const double due = rate_hz_ > 0.0 ? rate_hz_ * elapsed_s(begin) : 1e300;
        const auto now = Clock::now();
        while (open_.size() < kOpenMax && static_cast<double>(asked_) < due)
        {
            const auto chunk = static_cast<std::uint32_t>(mixed(kSeed, asked_) % chunks_);
            ++asked_;
            if (open_.emplace(chunk, Open{now, now}).second)
            {
                batch_.push_back({ContentKind::chunk, chunk});
            }
        }
        send();
    }
    void ask_again()
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
    void send()
    {
        if (!batch_.empty())
        {
            link_.request(batch_, ++generation_);
            batch_.clear();
        }
    }
    void receive(ContentKey key, std::span<const std::byte> bytes) override
    {
        const auto open = open_.find(key.number);
        if (open == open_.end())
        {
            return;
        }
        times_.add(
            std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - open->second.first)
                .count());
        bytes_ += bytes.size();
        open_.erase(open);
    }

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

int run(int argc, char** argv)
{
    CLI::App app("Asks a host for chunks and tells how long they took, as JSON.", "stream_client");
    Options options;
    app.add_option("--model", options.model, "NAME[@HASH]")->required();
    app.add_option("--name", options.name, "Its own, for the host")->capture_default_str();
    app.add_option("--domain", options.domain, "DDS domain id")->check(CLI::Range(0, 232));
    app.add_option("--rate", options.rate_hz, "Chunks a second; 0: as fast as they come")
        ->check(number_between(0.0, 1e6));
    app.add_option("--seconds", options.seconds, "How long")->check(number_between(0.1, 86'400.0));
    if (const std::optional<int> code = parse_command_line(app, argc, argv))
    {
        return *code;
    }
    const auto selector = parse_selector(options.model);
    if (!selector || !is_valid_name(options.name))
    {
        return fail(app,
                    "--model, --name: at most 63 of [A-Za-z0-9._-], @ and 32 hexadecimal "
                    "digits after a model's",
                    kExitUsage);
    }
    std::signal(SIGTERM, [](int) { stop_requested = 1; });
    auto client = dds::DdsClient::create(options.domain, options.name, {});
    if (!client)
    {
        return fail(app, client.error().text);
    }
    auto model =
        client.value()->find(selector.value(), kFindTimeout, [] { return stop_requested == 0; });
    if (!model)
    {
        return fail(app, model.error().text);
    }
    fmt::print(stderr, "connected\n");
    Client asking(model.value(), options.rate_hz);
    asking.run(options.seconds);
    fmt::print("{}\n", asking.to_json());
    return kExitDone;
}

} // namespace
} // namespace tactus::bench

int main(int argc, char** argv)
{
    try
    {
        return tactus::bench::run(argc, argv);
    }
    catch (const std::exception& error)
    {
        fmt::print(stderr, "stream_client: {}\n", error.what());
        return tactus::kExitFailed;
    }
}
