// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/header.hpp"
#include "transport/dds/catalogue.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/topics.hpp"
#include "transport/edit_request.hpp"
#include "transport/edit_state.hpp"
#include "transport/log.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

struct tactus_v5_Edits; // idlc's type of a sample.

namespace tactus::dds
{

/// Edit in a sample without a fault (fault_of()). The refusal is one line: more parts than a sum of
/// the model can have, a payload that decode_edit() refuses, or another edit than stated.
[[nodiscard]] Result<EditContent, Refusal> edit_from(const tactus_v5_Edits& sample,
                                                     const ModelHeader& header);

/// Receives and checks the edits of a controller's models from the servers that it follows. One
/// thread, that of the catalogue; no call waits.
///
/// The edits for the frame have the controller's own numbers, since a sum of a server's edits
/// becomes several steps. An edit that does not follow waits for the ones before it or for a sum.
/// If another server is followed, its sum decides. While a server lacks edits that the model has,
/// or needs more room, the model keeps its surface and gets no edits.
class EditReader
{
public:
    struct Model
    {
        std::string name; ///< For log lines.
        ContentHash hash{};
        ModelHeader header;    ///< View; its bytes must outlive the reader.
        std::uint32_t room{0}; ///< Slots for added faces; 0: the model is not edited.
    };
    struct Counts
    {
        std::uint64_t edits{0};   ///< Edits for the frame, including steps of sums.
        std::uint64_t sums{0};    ///< Sums that were used.
        std::uint64_t gaps{0};    ///< Times that an edit arrived before one that it follows.
        std::uint64_t refused{0}; ///< Refused samples and sums, and edits that a frame refused.
        bool is_stopped{false};   ///< True while the model gets no edits.
    };

    /// `domain` and `catalogue` must outlive the reader. `log` gets, at a limited rate, a line for
    /// each refusal.
    EditReader(const Domain& domain, const Catalogue& catalogue, std::vector<Model> models,
               Log log = {});

    /// Follows this server for the model; 0: none. Cheap if nothing changes.
    void follow(std::size_t model, std::uint64_t server_epoch);
    /// Takes samples and prepares edits. Bounded.
    void poll();
    /// Next edit of the model for the frame; null if there is none. Valid until poll() or pop().
    [[nodiscard]] const EditContent* next(std::size_t model) const;
    /// Removes the next edit, which must exist (asserted).
    void pop(std::size_t model);

    /// Ends the edits of a model for good, with one line, after a frame has refused one: all behind
    /// it would be refused, too.
    void end(std::size_t model);

    /// Number of the model on its server; none if that is not known yet.
    [[nodiscard]] std::optional<std::uint32_t> number_of(std::size_t model) const;
    [[nodiscard]] const Counts& counts(std::size_t model) const { return feeds_[model].counts; }
    /// Surface with all edits that next() has returned or will return now.
    [[nodiscard]] const EditState& state(std::size_t model) const { return feeds_[model].state; }

private:
    /// Parts of the newest sum.
    struct Sum
    {
        std::uint32_t to{0};
        std::uint32_t parts{0}; ///< 0: there is no sum.
        std::map<std::uint32_t, EditContent> received;
    };
    struct Feed
    {
        explicit Feed(Model of) : model(std::move(of)), state(model.header.counts(), model.room) {}

        Model model;
        EditState state;
        std::uint64_t server_epoch{0};
        std::optional<std::uint32_t> number{}; ///< Number on the server.
        std::uint32_t revision{0};             ///< The server's revision that `state` has.
        bool needs_sum{false}; ///< True after a change of the server, until its sum has arrived.
        bool has_gap{false};
        std::map<std::uint32_t, EditContent> pending{}; ///< Single edits by the revision before.
        Sum sum{};
        std::deque<EditContent> ready{};
        Counts counts{};
    };

    [[nodiscard]] bool try_find_numbers(std::uint64_t server_epoch);
    void open_endpoints();
    void take(std::uint64_t server_epoch, const Endpoint& endpoint);
    [[nodiscard]] std::optional<std::string> take(Feed& feed, const tactus_v5_Edits& sample);
    void advance(Feed& feed);
    void take_single(Feed& feed);
    void take_sum(Feed& feed);
    void stop(Feed& feed, const std::string& why);
    void refuse(Feed& feed, const std::string& text);

    const Domain& domain_;
    const Catalogue& catalogue_;
    RateLimitedLog log_;
    std::vector<Feed> feeds_;
    std::map<std::uint64_t, Endpoint> endpoints_; ///< Readers by the server's epoch.
};

/// Sends edit requests of a controller to servers. One thread.
class EditWriter
{
public:
    /// `domain` must outlive the writer. `log` gets a line for each server to which the rights of
    /// this participant permit no requests.
    explicit EditWriter(const Domain& domain, Log log = {}) : domain_(domain), log_(std::move(log))
    {
    }

    /// Sends a request, with its controller and serial number set. False if it is not sound
    /// (is_sound()), this participant has no right to it, the server does not listen yet, or the
    /// writer has no room.
    [[nodiscard]] bool try_send(EditRequest request);
    [[nodiscard]] std::uint64_t sent() const noexcept { return serial_; }

private:
    const Domain& domain_;
    RateLimitedLog log_;
    /// Writers by the server's epoch; those that could not be made are invalid.
    std::map<std::uint64_t, Endpoint> endpoints_;
    std::uint64_t serial_{0};
};

} // namespace tactus::dds
