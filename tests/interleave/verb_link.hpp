// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/unit/transport/tiny_model.hpp"
#include "transport/chunk_link.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace tactus::interleave
{

/// Effect of the link on everything in transit at the next poll.
enum class Weather : std::uint8_t
{
    delivers,
    holds,
    loses,
    damages,  ///< Flips one bit of the first piece.
    reverses, ///< Delivers the last piece first.
    repeats,  ///< Delivers each piece twice.
};

/// Controlled link, with callbacks where the haptic thread may run within the loader's step.
class VerbLink final : public ChunkLink
{
public:
    explicit VerbLink(const test::TinyModel& model) : model_(model) {}

    void request(std::span<const ContentKey> keys, std::uint32_t /*generation*/) override
    {
        if (state_ == LinkState::connected)
        {
            on_their_way_.insert(on_their_way_.end(), keys.begin(), keys.end());
        }
        call(at_request);
    }

    void poll(PieceSink& sink) override
    {
        const bool is_one = on_their_way_.size() == 1;
        was_felt_ = !on_their_way_.empty() && !(is_one && weather == Weather::reverses);
        if (weather == Weather::holds)
        {
            return;
        }
        std::vector<ContentKey> keys = std::exchange(on_their_way_, {});
        if (weather == Weather::loses)
        {
            return;
        }
        if (weather == Weather::reverses)
        {
            std::ranges::reverse(keys);
        }
        for (std::size_t i = 0; i < keys.size(); ++i)
        {
            call(before_piece);
            deliver(keys[i], weather == Weather::damages && i == 0, sink);
            if (weather == Weather::repeats)
            {
                deliver(keys[i], false, sink);
            }
        }
    }

    void lose_server()
    {
        state_ = LinkState::server_gone;
        on_their_way_.clear();
    }
    void regain_server()
    {
        state_ = LinkState::connected;
        ++session_;
    }

    [[nodiscard]] LinkState state() const override { return state_; }
    [[nodiscard]] std::uint64_t session() const override { return session_; }
    [[nodiscard]] std::uint64_t bytes_received() const override { return 0; }
    /// True if another weather would have changed the last poll().
    [[nodiscard]] bool was_weather_felt() const { return was_felt_; }

    Weather weather{Weather::delivers};
    std::function<void()> at_request;   ///< Called after requests and freed slots were taken.
    std::function<void()> before_piece; ///< Called for each delivered piece.

private:
    static void call(const std::function<void()>& function)
    {
        if (function)
        {
            function();
        }
    }
    void deliver(ContentKey key, bool is_damaged, PieceSink& sink)
    {
        bytes_.assign(model_.piece(key).begin(), model_.piece(key).end());
        if (is_damaged)
        {
            bytes_[bytes_.size() / 2] ^= std::byte{4};
        }
        sink.receive(key, bytes_);
    }

    const test::TinyModel& model_;
    std::vector<ContentKey> on_their_way_;
    std::vector<std::byte> bytes_;
    LinkState state_{LinkState::connected};
    std::uint64_t session_{1};
    bool was_felt_{false};
};

} // namespace tactus::interleave
