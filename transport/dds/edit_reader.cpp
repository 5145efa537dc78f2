// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/edit_reader.hpp"

#include "rt_core/base/assert.hpp"
#include "transport/dds/edit_publisher.hpp"
#include "transport/dds/take.hpp"
#include "transport/dds/wire_values.hpp"
#include "transport/edit_content.hpp"

#include <dds/dds.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <span>

#include "tactus.h"

namespace tactus::dds
{

namespace
{

/// Maximum number of samples taken from one server in one poll; further ones wait in the reader.
constexpr std::size_t kEditsPerPoll = 64;

} // namespace

Result<EditContent, Refusal> edit_from(const tactus_v5_Edits& sample, const ModelHeader& header)
{
    const bool is_sum = sample.index >= kKeptEdits;
    const auto most_parts = most_sum_parts(header.counts(), kMaxAddedFaces);
    if (is_sum && sample.parts > most_parts)
    {
        return Refusal{
            fmt::format("a sum has {} parts; at most {} are allowed", sample.parts, most_parts)};
    }
    auto edit =
        decode_edit(std::as_bytes(std::span(sample.payload._buffer, sample.payload._length)),
                    header, is_sum ? kMaxSumFaces : kMaxEditFaces);
    const std::uint32_t revision = is_sum ? sample.part + 1 : sample.to;
    if (edit && edit.value().revision != revision)
    {
        return Refusal{fmt::format("an edit has the number {} in a sample for {}",
                                   edit.value().revision, revision)};
    }
    return edit;
}

EditReader::EditReader(const Domain& domain, const Catalogue& catalogue, std::vector<Model> models,
                       Log log)
    : domain_(domain), catalogue_(catalogue), log_(std::move(log))
{
    for (Model& model : models)
    {
        feeds_.emplace_back(std::move(model));
    }
}

void EditReader::follow(std::size_t model, std::uint64_t server_epoch)
{
    Feed& feed = feeds_[model];
    if (feed.server_epoch == server_epoch)
    {
        return;
    }
    feed.server_epoch = server_epoch;
    feed.number.reset();
    feed.pending.clear();
    feed.sum = {};
    feed.has_gap = false;
    feed.revision = 0;
    feed.needs_sum = feed.state.revision() > 0;
}

void EditReader::poll()
{
    open_endpoints();
    for (const auto& [epoch, endpoint] : endpoints_)
    {
        if (try_find_numbers(epoch)) // Samples of unknown numbers stay in the reader.
        {
            take(epoch, endpoint);
        }
    }
    for (Feed& feed : feeds_)
    {
        advance(feed);
    }
}

const EditContent* EditReader::next(std::size_t model) const
{
    const Feed& feed = feeds_[model];
    return feed.ready.empty() ? nullptr : &feed.ready.front();
}

void EditReader::pop(std::size_t model)
{
    TACTUS_ASSERT(!feeds_[model].ready.empty());
    feeds_[model].ready.pop_front();
}

void EditReader::end(std::size_t model)
{
    Feed& feed = feeds_[model];
    if (std::exchange(feed.model.room, 0U) == 0)
    {
        return;
    }
    feed.number.reset();
    feed.pending.clear();
    feed.sum = {};
    feed.ready.clear();
    feed.counts.is_stopped = true;
    refuse(feed, "a frame has refused an edit; the model keeps its surface and gets no more edits");
}

std::optional<std::uint32_t> EditReader::number_of(std::size_t model) const
{
    return feeds_[model].number;
}

/// Finds the models' numbers on a server; true if all of them are known.
bool EditReader::try_find_numbers(std::uint64_t server_epoch)
{
    bool has_all = true;
    for (Feed& feed : feeds_)
    {
        if (feed.server_epoch != server_epoch || feed.model.room == 0)
        {
            continue;
        }
        if (const auto* offer =
                feed.number ? nullptr : catalogue_.find(feed.model.hash, server_epoch))
        {
            feed.number = offer->model;
        }
        has_all = has_all && feed.number.has_value();
    }
    return has_all;
}

/// Makes readers of the followed servers, and removes those of others.
void EditReader::open_endpoints()
{
    const auto is_followed = [&](std::uint64_t epoch)
    {
        return epoch != 0 &&
               std::ranges::any_of(feeds_, [&](const Feed& feed)
                                   { return feed.server_epoch == epoch && feed.model.room > 0; });
    };
    std::erase_if(endpoints_, [&](const auto& known) { return !is_followed(known.first); });
    for (const Feed& feed : feeds_)
    {
        const std::uint64_t epoch = feed.server_epoch;
        if (!is_followed(epoch) || endpoints_.contains(epoch))
        {
            continue;
        }
        auto endpoint = make_reader(domain_, Topic::edits, server_partition(epoch));
        if (endpoint)
        {
            endpoints_.emplace(epoch, std::move(endpoint).value());
        }
        else
        {
            log_.write(endpoint.error().text); // The next poll tries again.
        }
    }
}

void EditReader::take(std::uint64_t server_epoch, const Endpoint& endpoint)
{
    take_each<tactus_v5_Edits>(
        endpoint.handle, kEditsPerPoll,
        [&](const tactus_v5_Edits& sample, const dds_sample_info_t& info)
        {
            if (!info.valid_data)
            {
                return; // The end of a server; its edits stay.
            }
            for (Feed& feed : feeds_)
            {
                if (sample.server_epoch != server_epoch || feed.server_epoch != server_epoch ||
                    feed.number != sample.model)
                {
                    continue;
                }
                if (const auto fault = take(feed, sample))
                {
                    domain_.participants().refuse(info.publication_handle, Refused::edit,
                                                  sample.model);
                    refuse(feed, *fault);
                }
            }
        });
}

/// Keeps one sample; returns a reason if it is refused. make_reader() has checked its numbers
/// against each other, so at most one edit is kept for each part.
std::optional<std::string> EditReader::take(Feed& feed, const tactus_v5_Edits& sample)
{
    const bool is_sum = sample.index >= kKeptEdits;
    const bool is_old = !feed.needs_sum && sample.to <= feed.revision;
    if (is_old)
    {
        return std::nullopt;
    }
    if (is_sum && feed.sum.parts != 0 && sample.to < feed.sum.to)
    {
        return std::nullopt; // A newer sum is under way.
    }
    auto edit = edit_from(sample, feed.model.header);
    if (!edit)
    {
        return edit.error().text;
    }
    if (!is_sum)
    {
        feed.pending.insert_or_assign(sample.from, std::move(edit).value());
        if (feed.pending.size() > kKeptEdits)
        {
            feed.pending.erase(feed.pending.begin());
        }
        return std::nullopt;
    }
    if (feed.sum.parts != sample.parts || feed.sum.to != sample.to)
    {
        feed.sum = {sample.to, sample.parts, {}};
    }
    feed.sum.received.insert_or_assign(sample.part, std::move(edit).value());
    return std::nullopt;
}

/// Prepares edits for the frame if none is left.
void EditReader::advance(Feed& feed)
{
    if (!feed.ready.empty())
    {
        return;
    }
    take_single(feed);
    const bool is_whole = feed.sum.parts > 0 && feed.sum.received.size() == feed.sum.parts;
    if (feed.ready.empty() && is_whole && (feed.needs_sum || feed.sum.to > feed.revision))
    {
        take_sum(feed);
        take_single(feed);
    }
    if (!feed.needs_sum && feed.sum.to <= feed.revision)
    {
        feed.sum = {};
    }
    const bool has_gap = !feed.pending.empty() && feed.ready.empty() && !feed.needs_sum;
    feed.counts.gaps += has_gap && !feed.has_gap ? 1U : 0U;
    feed.has_gap = has_gap;
}

/// Takes the single edits that follow the revision.
void EditReader::take_single(Feed& feed)
{
    while (!feed.needs_sum)
    {
        feed.pending.erase(feed.pending.begin(), feed.pending.lower_bound(feed.revision));
        if (feed.pending.empty() || feed.pending.begin()->first != feed.revision)
        {
            return;
        }
        EditContent edit = std::move(feed.pending.begin()->second);
        feed.pending.erase(feed.pending.begin());
        edit.revision = feed.state.revision() + 1;
        if (const auto fault = feed.state.fault_of(edit))
        {
            refuse(feed, fault->text); // A sum may lead on.
            return;
        }
        feed.state.apply(edit);
        ++feed.revision;
        ++feed.counts.edits;
        feed.ready.push_back(std::move(edit));
    }
}

/// Goes to the surface of a complete sum.
void EditReader::take_sum(Feed& feed)
{
    const Sum sum = std::exchange(feed.sum, {});
    EditState target(feed.model.header.counts(), kMaxAddedFaces);
    for (const auto& [part, edit] : sum.received)
    {
        if (const auto fault = target.fault_of(edit, kMaxSumFaces))
        {
            refuse(feed, fmt::format("part {} of a sum: {}", part, fault->text));
            return;
        }
        target.apply(edit);
    }
    if (sum.to == 0 && feed.state.revision() > 0)
    {
        stop(feed, "its server has lost its edits");
        return;
    }
    if (!target.added().empty() && target.added().rbegin()->first >= feed.state.room())
    {
        stop(feed, fmt::format("its server uses slot {} for added faces, but the room is {} "
                               "(--edit-faces)",
                               target.added().rbegin()->first, feed.state.room()));
        return;
    }
    if (!feed.state.leads_to(target))
    {
        stop(feed, "its server has other edits");
        return;
    }
    for (EditContent& step : feed.state.steps_to(target))
    {
        feed.state.apply(step);
        ++feed.counts.edits;
        feed.ready.push_back(std::move(step));
    }
    feed.revision = sum.to;
    feed.needs_sum = false;
    feed.counts.is_stopped = false;
    ++feed.counts.sums;
}

/// Takes no edits until a sum leads on.
void EditReader::stop(Feed& feed, const std::string& why)
{
    feed.needs_sum = true;
    if (!std::exchange(feed.counts.is_stopped, true))
    {
        refuse(feed, why + "; the model keeps its surface");
    }
}

void EditReader::refuse(Feed& feed, const std::string& text)
{
    ++feed.counts.refused;
    log_.write(fmt::format("model '{}': {}", feed.model.name, text));
}

bool EditWriter::try_send(EditRequest request)
{
    if (!is_sound(request))
    {
        return false;
    }
    auto known = endpoints_.find(request.server_epoch);
    if (known == endpoints_.end())
    {
        auto endpoint =
            make_writer(domain_, Topic::edit_requests, server_partition(request.server_epoch));
        if (!endpoint)
        {
            log_.write("edit requests can't be sent: " + endpoint.error().text);
        }
        known =
            endpoints_
                .emplace(request.server_epoch, endpoint ? std::move(endpoint).value() : Endpoint())
                .first;
    }
    if (!is_matched(known->second))
    {
        return false;
    }
    tactus_v5_EditRequests wire = {};
    const ControllerId& own = domain_.participants().own();
    std::memcpy(wire.controller, own.data(), own.size());
    wire.server_epoch = request.server_epoch;
    wire.model = request.model;
    wire.serial = serial_ + 1;
    wire.kind = static_cast<std::uint8_t>(request.kind);
    wire.radius_m = request.radius_m;
    std::ranges::copy(request.half_axis_m, std::begin(wire.half_axis_m));
    std::vector<tactus_v5_HullVertex> hull(request.hull_m.size());
    for (std::size_t i = 0; i < hull.size(); ++i)
    {
        std::ranges::copy(request.hull_m[i], std::begin(hull[i].place_m));
    }
    const auto vertices = static_cast<std::uint32_t>(hull.size());
    wire.hull = {vertices, vertices, hull.data(), false};
    wire.from = to_wire(request.from);
    wire.to = to_wire(request.to);
    wire.amount_m = request.amount_m;
    if (dds_write(known->second.handle, &wire) != DDS_RETCODE_OK)
    {
        return false;
    }
    ++serial_;
    return true;
}

} // namespace tactus::dds
