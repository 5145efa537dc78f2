// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/model_pieces.hpp"
#include "transport/dds/object_publisher.hpp"
#include "transport/dds/subscription.hpp"
#include "transport/log.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

struct tactus_v5_Wanted; // idlc's type of a sample.

namespace tactus::dds
{

/// Serves models on one DDS domain: announces them, gives pieces to whoever asks, under the credit
/// that each controller grants, and shows objects. One thread.
class DdsHost
{
public:
    /// Totals since the start, over all controllers.
    struct Counters
    {
        std::uint64_t pieces_sent{0};
        std::uint64_t bytes_sent{0}; ///< Payload.
        std::uint64_t requests{0};
        std::uint64_t requests_refused{0}; ///< A bad name, an unknown piece, too many.
        std::uint64_t renewed{0}; ///< Times that writers were replaced that were not heard.
    };
    struct Subscriber
    {
        std::string controller;
        std::uint64_t pieces_sent{0};
        std::uint64_t bytes_sent{0};
    };

    /// Announces the models. Refused: more than kMaxModels, one whose base mesh can't be read or
    /// whose header is too long for the wire, and what Domain::join() refuses. `log` gets, at a
    /// limited rate, a line when a controller comes or goes and one for what can't be served or is
    /// refused. `scene`, a valid name (unchecked), is what controllers call all of the host's
    /// objects together; empty: nothing.
    [[nodiscard]] static Result<std::unique_ptr<DdsHost>, Refusal>
    create(std::uint32_t domain, std::vector<PublishedModel> models, Log log,
           std::string scene = {}, Party party = Party::host);

    /// Waits until there is something to do, at most `timeout`. Signals don't end it early.
    void wait(std::chrono::milliseconds timeout);
    /// Sends what has moved, then takes requests, serves, which reads the models' files, and
    /// announces when due, each for some milliseconds at most: call it again at once when wait()
    /// does. First served is the process that got least lately, and in it the controller that did.
    void step();

    [[nodiscard]] Counters counters() const;
    [[nodiscard]] std::vector<Subscriber> subscribers() const;
    [[nodiscard]] const std::vector<ModelPieces>& models() const noexcept { return models_; }
    /// Shows, moves and removes objects of these models.
    [[nodiscard]] ObjectPublisher& objects() noexcept { return *objects_; }
    /// By which controllers know this run of this host.
    [[nodiscard]] std::uint64_t epoch() const noexcept { return epoch_; }
    /// For further topics of the same program; lives as long as the host.
    [[nodiscard]] const Domain& domain() const noexcept { return domain_; }

private:
    using Clock = std::chrono::steady_clock;
    enum class Joining : std::uint8_t
    {
        not_wanted,
        waits,
        under_way, ///< It was let in; the objects are on their way to it.
        done,
    };
    /// All controllers of one process, as it names itself.
    struct Process
    {
        std::string name;
        std::uint64_t asked{0};     ///< Pieces, in the last second.
        double got_bytes{0.0};      ///< Recently; halved every 250 ms.
        Clock::time_point let_in{}; ///< When the last one was.
    };
    struct Client
    {
        Subscription subscription;
        std::shared_ptr<Process> process;
        double got_bytes{0.0}; ///< As its process has.
        Joining joining{Joining::not_wanted};
        Clock::time_point let_in{};
        std::uint64_t writer{0}; ///< Handle of the last request's.
        std::uint64_t passed{0}; ///< The step in which there was nothing for it.
        Backoff motion_renewals{};
        bool is_disputed{false}; ///< Somebody said that it is gone, perhaps another program.
    };

    DdsHost(Domain domain, std::vector<ModelPieces> models, Log log, std::string scene);

    [[nodiscard]] Result<Done, Refusal> open_endpoints();
    void announce();
    void take_requests(Clock::time_point end);
    void on_request(const ControllerId& controller, const tactus_v5_Wanted& wanted);
    void take_wishes(Client& client, const tactus_v5_Wanted& wanted);
    void renew_motion(Client& client);
    bool try_heal(Client& client);
    void refuse(const ControllerId& controller, Refused reason);
    [[nodiscard]] Client* add_client(const ControllerId& controller,
                                     const tactus_v5_Wanted& wanted);
    void on_end(const ControllerId& controller, std::uint64_t writer);
    /// Of what a stranger wrote in a controller's name too, DDS tells no end while the stranger is
    /// here: a controller goes with its writer or its participant. Looks at those of which somebody
    /// said so, and at some others in turn.
    void look_for_gone();
    void on_controller_gone(const ControllerId& controller);
    void forget();
    void serve(Clock::time_point end);
    [[nodiscard]] Client* next_to_serve();
    void let_in();
    [[nodiscard]] Client* find(const ControllerId& controller);

    Domain domain_; ///< First, so that it is left last.
    std::vector<ModelPieces> models_;
    std::string scene_;
    RateLimitedLog visits_log_;
    RateLimitedLog fault_log_;
    std::uint64_t epoch_;
    Endpoint catalogue_;
    Endpoint wanted_;
    Entity waitset_;
    std::unique_ptr<ObjectPublisher> objects_; ///< From create() on.
    std::vector<Client> clients_;
    std::vector<std::shared_ptr<Process>> processes_;
    std::size_t looked_at_{0}; ///< Of clients_, by look_for_gone().
    std::uint64_t steps_{0};
    bool has_more_work_{false};
    Clock::time_point last_announced_{};
    Clock::time_point last_forgot_{};
    Clock::time_point last_looked_{};
    PieceBuffers room_;
    Counters counters_;
};

} // namespace tactus::dds
