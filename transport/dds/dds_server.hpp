// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/edit_publisher.hpp"
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

/// Serves models on one DDS domain: announces them, sends requested pieces within the credit
/// (CreditWindow) that each controller grants, and publishes objects. One thread.
class DdsServer
{
public:
    /// Totals since the start, over all controllers.
    struct Counters
    {
        std::uint64_t pieces_sent{0};
        std::uint64_t bytes_sent{0}; ///< Bytes of payload.
        std::uint64_t requests{0};
        /// Requests for unknown pieces, from invalid or too many controllers, or beyond the rate
        /// limit.
        std::uint64_t requests_refused{0};
        /// Number of times that writers were replaced because a controller received nothing.
        std::uint64_t renewed{0};
    };
    struct Subscriber
    {
        std::string controller;
        std::uint64_t pieces_sent{0};
        std::uint64_t bytes_sent{0};
    };

    /// Announces the models. Refused for more than kMaxModels, an unreadable base mesh, a header
    /// too long for the wire, and as by Domain::join(). `log` gets, at a limited rate, a line for
    /// each controller that arrives or leaves, each failure and each refusal. `scene` is a valid
    /// name (unchecked) for all objects of the server together; empty: no scene. `editors` may
    /// request edits of the models with a room for them.
    [[nodiscard]] static Result<std::unique_ptr<DdsServer>, Refusal>
    create(const DomainChoice& domain, std::vector<PublishedModel> models, Log log,
           std::string scene = {}, Party party = Party::server, Editors editors = {});

    /// Waits for a request or the next step() that is due, at most `timeout`. Signals do not end
    /// it.
    void wait(std::chrono::milliseconds timeout);
    /// Sends motion, takes requests, sends pieces and announces models if due. Takes a few
    /// milliseconds and reads the models' files. Call it again as soon as wait() returns. The
    /// process with the fewest recent bytes is served first, and within it the controller with the
    /// fewest.
    void step();

    [[nodiscard]] Counters counters() const;
    [[nodiscard]] std::vector<Subscriber> subscribers() const;
    [[nodiscard]] const std::vector<ModelPieces>& models() const noexcept { return models_; }
    /// Publisher of the objects of these models.
    [[nodiscard]] ObjectPublisher& objects() noexcept { return *objects_; }
    /// Publisher of the edits of these models; null if none of them can be edited.
    [[nodiscard]] EditPublisher* edits() noexcept { return edits_.get(); }
    /// Epoch, which identifies this run of the server to controllers.
    [[nodiscard]] std::uint64_t epoch() const noexcept { return epoch_; }
    /// Domain for further topics of the same program; lives as long as the server.
    [[nodiscard]] const Domain& domain() const noexcept { return domain_; }

private:
    using Clock = std::chrono::steady_clock;
    enum class Joining : std::uint8_t
    {
        not_wanted,
        waits,
        under_way, ///< The controller was admitted and receives the objects.
        done,
    };
    /// All controllers of one process, found by the process name in DDS.
    struct Process
    {
        std::string name;
        std::uint64_t asked{0};       ///< Recently requested pieces; decays over about a second.
        double got_bytes{0.0};        ///< Bytes recently sent to it; halved every 250 ms.
        Clock::time_point admitted{}; ///< Time when one of its controllers was last admitted.
    };
    struct Client
    {
        Subscription subscription;
        std::shared_ptr<Process> process;
        double got_bytes{0.0}; ///< Bytes recently sent to it; halved every 250 ms.
        Joining joining{Joining::not_wanted};
        Clock::time_point admitted{};
        std::uint64_t writer{0}; ///< Handle of the last request's writer.
        std::uint64_t passed{0}; ///< Number of the last step() in which send_one() failed.
        Backoff motion_renewals{};
        /// True if any program ended this controller's instance in DDS; remove_gone_controllers()
        /// then checks.
        bool is_disputed{false};
    };

    DdsServer(Domain domain, std::vector<ModelPieces> models, Log log, std::string scene);

    [[nodiscard]] Result<Done, Refusal> open_endpoints(Editors editors);
    [[nodiscard]] Result<Done, Refusal> open_edits(Editors editors);
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
    /// Removes controllers whose writer or participant is gone. DDS may not report such an end if
    /// an unknown participant also wrote in the controller's name. Checks all disputed controllers,
    /// and the others in turn.
    void remove_gone_controllers();
    void on_controller_gone(const ControllerId& controller);
    void forget();
    void serve(Clock::time_point end);
    [[nodiscard]] Client* next_to_serve();
    void admit_waiting();
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
    std::unique_ptr<EditPublisher> edits_;     ///< Null if no model can be edited.
    std::vector<Client> clients_;
    std::vector<std::shared_ptr<Process>> processes_;
    std::size_t looked_at_{
        0}; ///< First index into clients_ for the next remove_gone_controllers().
    std::uint64_t steps_{0};
    bool has_more_work_{false};
    Clock::time_point last_announced_{};
    Clock::time_point last_forgot_{};
    Clock::time_point last_looked_{};
    PieceBuffers room_;
    Counters counters_;
};

} // namespace tactus::dds
