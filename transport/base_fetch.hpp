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

/// Fetches a model's base mesh over its link, part by part. If a server leaves midway, is silent or
/// sends wrong bytes, the fetch goes on with another server of the model.
class BaseFetch final : private PieceSink
{
public:
    enum class State : std::uint8_t
    {
        under_way,
        done,    ///< `base` of the model is complete and has the hash that its header names.
        refused, ///< Final: the bytes have another hash, and no other server has the model.
    };

    /// `model` must outlive the fetch and have a header as ServedModel states. The fetch of a model
    /// that already has a base mesh is done.
    explicit BaseFetch(ServedModel& model);

    /// Takes the parts that have arrived and requests the missing ones, again after a timeout.
    /// Never waits, except for a file's disk.
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
    std::uint64_t session_{0}; ///< Link session of the last request.
    Clock::time_point progress_{};
};

/// Waits until all these models have their base meshes, at most `timeout`, or until `go_on` (called
/// every few milliseconds) returns false. The refusal names a model that lacks its base mesh;
/// fetched base meshes stay.
[[nodiscard]] std::optional<Refusal> bring_bases(std::span<ServedModel> models,
                                                 std::chrono::milliseconds timeout,
                                                 const std::function<bool()>& go_on = {});

} // namespace tactus
