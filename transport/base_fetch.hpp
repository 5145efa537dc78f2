// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"
#include "transport/part_intake.hpp"
#include "transport/served_model.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

// One thread, that of the models' links.
namespace tactus
{

/// Fetches a model's base mesh over its link, part by part: a host that goes in the middle, is
/// silent or sends what is wrong is no loss where another one serves the model.
class BaseFetch final : private PieceSink
{
public:
    enum class State : std::uint8_t
    {
        under_way,
        done,    ///< The model's `base` is whole and has the hash that its header names.
        refused, ///< For good: it has another one, and no other server has it.
    };

    /// The model must outlive it, and its header be as ServedModel says; one with a base mesh is
    /// done.
    explicit BaseFetch(ServedModel& model);

    /// Takes what has come, and asks for what is missing, again where nothing comes. Never waits
    /// but for a file's disk.
    State step();

    [[nodiscard]] const ServedModel& model() const noexcept { return model_; }

private:
    using Clock = std::chrono::steady_clock;
    void receive(ContentKey key, std::span<const std::byte> bytes) override;
    void ask();
    State check();

    ServedModel& model_;
    ModelHeader header_;
    PartIntake parts_;
    State state_{State::under_way};
    std::uint64_t session_{0}; ///< Of the last request.
    Clock::time_point progress_{};
};

/// Waits until all these models have their base meshes: at most `timeout`, or until `go_on` (asked
/// every few milliseconds) returns false. Those that came stay when it is refused, which says why.
[[nodiscard]] std::optional<Refusal> bring_bases(std::span<ServedModel> models,
                                                 std::chrono::milliseconds timeout,
                                                 const std::function<bool()>& go_on = {});

} // namespace tactus
