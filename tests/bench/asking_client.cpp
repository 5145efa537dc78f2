// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/asking_client.hpp"

#include "rt_core/spm/header.hpp"
#include "tests/bench/bench_row.hpp"
#include "tests/shared/random.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>
#include <thread>

namespace tactus::bench
{

namespace
{

constexpr std::size_t kOpenMax = 256;
constexpr auto kRetry = std::chrono::milliseconds(200);
/// Pauses between two polls. The shortest is that of a controller's transport thread; slow clients
/// take a tenth of the time between two chunks, so that many run on few processors.
constexpr double kPauseMin_s = 300e-6;
constexpr double kPauseMax_s = 10e-3;

} // namespace

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

} // namespace tactus::bench
