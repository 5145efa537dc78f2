// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/base_fetch.hpp"

#include "transport/content_hash.hpp"

#include <fmt/format.h>

#include <list>
#include <thread>
#include <utility>
#include <vector>

namespace tactus
{

namespace
{

/// Pause between two rounds over the fetches.
constexpr auto kPause = std::chrono::milliseconds(1);
/// Time without a new part after which missing parts are requested again.
constexpr auto kAgain = std::chrono::milliseconds(100);

} // namespace

BaseFetch::BaseFetch(ServedModel& model)
    : model_(model)
    , header_(ModelHeader::parse(model.header).value())
    , parts_(ContentKind::base, header_.fields().base_bytes)
    , state_(model.base.empty() ? State::under_way : State::done)
{
}

BaseFetch::State BaseFetch::step()
{
    if (state_ != State::under_way)
    {
        return state_;
    }
    model_.link->poll(*this);
    if (parts_.missing() == 0)
    {
        return check();
    }
    const bool is_asked = model_.link->session() == session_ && Clock::now() - progress_ < kAgain;
    if (!is_asked && model_.link->state() == LinkState::connected)
    {
        request_missing();
    }
    return state_;
}

void BaseFetch::receive(ContentKey key, std::span<const std::byte> bytes)
{
    progress_ = parts_.receive(key, bytes) ? Clock::now() : progress_;
}

void BaseFetch::request_missing()
{
    session_ = model_.link->session();
    progress_ = Clock::now();
    std::vector<ContentKey> keys;
    parts_.list_missing(keys, parts_.missing());
    model_.link->request(keys, 0);
}

BaseFetch::State BaseFetch::check()
{
    if (content_hash(parts_.bytes()) != header_.fields().base_hash)
    {
        if (!model_.link->distrust({ContentKind::base, 0}))
        {
            return state_ = State::refused;
        }
        parts_ = PartIntake(ContentKind::base, header_.fields().base_bytes);
        session_ = 0; // Requests all parts at the next step.
        return state_;
    }
    model_.base = std::move(parts_.bytes());
    return state_ = State::done;
}

std::optional<Refusal> fetch_base_meshes(std::span<ServedModel> models,
                                         std::chrono::milliseconds timeout,
                                         const std::function<bool()>& go_on)
{
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    std::list<BaseFetch> fetches;
    for (ServedModel& model : models)
    {
        fetches.emplace_back(model);
    }
    for (;;)
    {
        for (auto fetch = fetches.begin(); fetch != fetches.end();)
        {
            const auto state = fetch->step();
            if (state == BaseFetch::State::refused)
            {
                return Refusal{fmt::format(
                    "model '{}' has a base mesh that does not match the hash in its header",
                    fetch->model().name)};
            }
            fetch = state == BaseFetch::State::done ? fetches.erase(fetch) : std::next(fetch);
        }
        if (fetches.empty())
        {
            return std::nullopt;
        }
        const auto waited = Clock::now() - start;
        if (waited >= timeout || (go_on && !go_on()))
        {
            const std::chrono::duration<double> seconds = waited;
            return Refusal{
                fmt::format("the base mesh of model '{}' did not arrive (waited {:.3g} s)",
                            fetches.front().model().name, seconds.count())};
        }
        std::this_thread::sleep_for(kPause);
    }
}

} // namespace tactus
