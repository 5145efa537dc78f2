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

/// Serves models on one DDS domain: announces them, sends pieces on request under the credit that
/// each controller grants, and shows objects. One thread.
class DdsHost
{
public:
    /// Totals since the start, over all controllers.
    struct Counters
    {
        std::uint64_t pieces_sent{0};
        std::uint64_t bytes_sent{0}; ///< Bytes of payload.
        std::uint64_t requests{0};
        /// Requests with a bad name or an unknown piece, and those beyond the rate limit.
        std::uint64_t requests_refused{0};
        std::uint64_t renewed{0}; ///< Replacements of writers that a controller did not receive.
    };
    struct Subscriber
    {
        std::string controller;
        std::uint64_t pieces_sent{0};
        std::uint64_t bytes_sent{0};
    };

    /// Announces the models. Refused: more than kMaxModels, a base mesh that cannot be read, a
    /// header too long for the wire, and the refusals of Domain::join(). `log` gets, at a limited
    /// rate, a line when a controller arrives or leaves, and one for each failure or refusal.
    /// `scene`, a valid name (unchecked), names all objects of the server together; empty: no
    /// scene.
    [[nodiscard]] static Result<std::unique_ptr<DdsHost>, Refusal>
    create(std::uint32_t domain, std::vector<PublishedModel> models, Log log,
           std::string scene = {}, Party party = Party::host);

    /// Waits until there is work, at most `timeout`. Signals do not end the wait.
    void wait(std::chrono::milliseconds timeout);
    /// Sends motion, takes requests, serves pieces, which reads the models' files, and announces
    /// when due. Each takes some milliseconds at most: call it again at once when wait() returns.
    /// The process that recently got the least is served first, and within it the controller that
    /// did.
    void step();

    [[nodiscard]] Counters counters() const;
    [[nodiscard]] std::vector<Subscriber> subscribers() const;
    [[nodiscard]] const std::vector<ModelPieces>& models() const noexcept { return models_; }
    /// Publisher that shows, moves and removes objects of these models.
    [[nodiscard]] ObjectPublisher& objects() noexcept { return *objects_; }
    /// Epoch by which controllers identify this run of this server.
    [[nodiscard]] std::uint64_t epoch() const noexcept { return epoch_; }
    /// Domain for further topics of the same program; lives as long as the server.
    [[nodiscard]] const Domain& domain() const noexcept { return domain_; }

private:
    using Clock = std::chrono::steady_clock;
    enum class Joining : std::uint8_t
    {
        not_wanted,
        waits,
        under_way, ///< Admitted; the objects are in transit to the controller.
        done,
    };
    /// All controllers of one process, by the name that it reports.
    struct Process
    {
        std::string name;
        std::uint64_t asked{0};     ///< Pieces requested in the last second.
        double got_bytes{0.0};      ///< Bytes received recently; halved every 250 ms.
        Clock::time_point let_in{}; ///< Time of its last admission.
    };
    struct Client
    {
        Subscription subscription;
        std::shared_ptr<Process> process;
        double got_bytes{0.0}; ///< Bytes received recently, like Process::got_bytes.
        Joining joining{Joining::not_wanted};
        Clock::time_point let_in{};
        std::uint64_t writer{0}; ///< Handle of the last request's writer.
        std::uint64_t passed{0}; ///< Last step in which nothing could be sent to it.
        Backoff motion_renewals{};
        /// True if a program, perhaps another one, ended this controller's instance.
        bool is_disputed{false};
    };

    DdsHost(Domain domain, std::vector<ModelPieces> models, Log log, std::string scene);

    [[nodiscard]] Result<Done, Refusal> open_endpoints();
    void announce();
    void take_requests(Clock::time_point end);
    void on_request(const ControllerId& controller, const tactus_v5_Wanted& wanted);
    void take_requests(Client& client, const tactus_v5_Wanted& wanted);
    void renew_motion(Client& client);
    bool try_heal(Client& client);
    void refuse(const ControllerId& controller, Refused reason);
    [[nodiscard]] Client* add_client(const ControllerId& controller,
                                     const tactus_v5_Wanted& wanted);
    void on_end(const ControllerId& controller, std::uint64_t writer);
    /// Removes controllers that are gone: a controller ends with its writer or its participant. If
    /// an unknown participant wrote in a controller's name too, DDS reports no end while that
    /// participant is present. Checks disputed controllers, and some others in turn.
    void look_for_gone();
    void on_controller_gone(const ControllerId& controller);
    void forget();
    void serve(Clock::time_point end);
    [[nodiscard]] Client* next_to_serve();
    void let_in();
    [[nodiscard]] Client* find(const ControllerId& controller);

    Domain domain_; ///< First member, so that it is destroyed last.
    std::vector<ModelPieces> models_;
    std::string scene_;
    RateLimitedLog visits_log_;
    RateLimitedLog fault_log_;
    std::uint64_t epoch_;
    Endpoint catalogue_;
    Endpoint wanted_;
    Entity waitset_;
    std::unique_ptr<ObjectPublisher> objects_; ///< Valid after create().
    std::vector<Client> clients_;
    std::vector<std::shared_ptr<Process>> processes_;
    std::size_t looked_at_{0}; ///< Next of clients_ for look_for_gone().
    std::uint64_t steps_{0};
    bool has_more_work_{false};
    Clock::time_point last_announced_{};
    Clock::time_point last_forgot_{};
    Clock::time_point last_looked_{};
    PieceBuffers room_;
    Counters counters_;
};

} // namespace tactus::dds
