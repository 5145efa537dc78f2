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

// One thread, the one that uses the links of the models.
namespace tactus
{

/// Fetches the base mesh of a model over its link, part by part. If a server leaves, is silent or
/// sends wrong bytes, the fetch continues with another server of the model.
class BaseFetch final : private PieceSink
{
public:
    enum class State : std::uint8_t
    {
        under_way,
        done,    ///< The model's `base` is complete and has the hash stored in its header.
        refused, ///< Final: the bytes have a wrong hash, and no other server has the model.
    };

    /// `model` must outlive the fetch, and its header must be verified (ServedModel). If `model`
    /// has a base mesh, the fetch is done.
    explicit BaseFetch(ServedModel& model);

    /// Takes the parts that have arrived and requests the missing ones, again after a timeout.
    /// Waits for nothing except the disk of a model's file.
    State step();

    [[nodiscard]] const ServedModel& model() const noexcept { return model_; }

private:
    using Clock = std::chrono::steady_clock;
    void receive(ContentKey key, std::span<const std::byte> bytes) override;
    void request_missing();
    State check();

    ServedModel& model_;
    ModelHeader header_;
    PartIntake parts_;
    State state_{State::under_way};
    std::uint64_t session_{0}; ///< ChunkLink::session() at the last request; 0: request at once.
    Clock::time_point progress_{};
};

/// Waits until all models have their base meshes, for at most `timeout`, or until `go_on`, called
/// about once a millisecond, returns false. The refusal names a model without base mesh; the meshes
/// fetched so far are kept.
[[nodiscard]] std::optional<Refusal> fetch_base_meshes(std::span<ServedModel> models,
                                                       std::chrono::milliseconds timeout,
                                                       const std::function<bool()>& go_on = {});

} // namespace tactus
