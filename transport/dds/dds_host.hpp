// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/base/refusal.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/subscription.hpp"
#include "transport/log.hpp"
#include "transport/store/model_store.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tactus::dds
{

/// A model under the name by which controllers ask for it.
struct PublishedModel
{
    std::string name; ///< Valid, and no other model of this host has it.
    ModelStore store;
};

/// Serves models on one DDS domain: announces them, gives header and base mesh to late joiners and
/// pieces to whoever asks, under the credit that each controller grants. One thread.
class DdsHost
{
public:
    /// Totals since the start, over all controllers.
    struct Counters
    {
        std::uint64_t pieces_sent{0};
        std::uint64_t bytes_sent{0}; ///< Payload.
        std::uint64_t requests{0};
        std::uint64_t requests_refused{0}; ///< Other version or revision, unknown piece, too many.
    };
    struct Subscriber
    {
        std::string controller;
        std::string model;
        std::uint64_t pieces_sent{0};
        std::uint64_t bytes_sent{0};
    };

    /// Announces the models. `log` gets a line when a controller comes or goes and, at a limited
    /// rate, one for what can't be served.
    [[nodiscard]] static Result<std::unique_ptr<DdsHost>, Refusal>
    create(std::uint32_t domain, std::vector<PublishedModel> models, Log log);

    /// Waits until there is something to do, at most `timeout`. Signals don't end it early.
    void wait(std::chrono::milliseconds timeout);
    /// Takes requests, serves a bounded number of samples round-robin, announces when due.
    void step();

    [[nodiscard]] Counters counters() const;
    [[nodiscard]] std::vector<Subscriber> subscribers() const;
    [[nodiscard]] const std::vector<PublishedModel>& models() const noexcept { return models_; }
    /// Random, of this run: a PosePublisher of these models needs it.
    [[nodiscard]] std::uint64_t epoch() const noexcept { return epoch_; }
    /// For further topics of the same program; lives as long as the host.
    [[nodiscard]] const Domain& domain() const noexcept { return domain_; }

private:
    using Clock = std::chrono::steady_clock;
    struct Request;

    DdsHost(Domain domain, std::vector<PublishedModel> models, Log log);

    [[nodiscard]] Result<Done, Refusal> open_endpoints();
    [[nodiscard]] Result<Done, Refusal> publish_start(const PublishedModel& model);
    void announce();
    void take_requests();
    void on_request(const Request& request);
    void on_controller_gone(const ControllerId& controller, const ContentHash& hash);
    void serve();
    [[nodiscard]] const PublishedModel* model_of(const ContentHash& hash) const;
    [[nodiscard]] std::vector<Subscription>::iterator find(const ControllerId& controller,
                                                           const ContentHash& hash);

    Domain domain_; ///< First, so that it is left last.
    std::vector<PublishedModel> models_;
    Log log_;
    RateLimitedLog fault_log_;
    std::uint64_t epoch_;
    std::vector<Endpoint> starts_;
    Endpoint catalogue_;
    Endpoint wanted_;
    Entity waitset_;
    std::vector<Subscription> subscriptions_;
    std::size_t next_turn_{0};
    bool has_more_work_{false};
    Clock::time_point last_announced_{};
    std::vector<std::byte> payload_;
    std::vector<std::byte> piece_;
    Counters counters_;
};

} // namespace tactus::dds
