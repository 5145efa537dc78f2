// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/edit_publisher.hpp"

#include "rt_core/base/assert.hpp"
#include "transport/dds/take.hpp"
#include "transport/dds/wire_values.hpp"

#include <dds/dds.h>
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tactus.h"

namespace tactus::dds
{

namespace
{

/// Time without edits after which the sum is written again.
constexpr auto kSumAfterRest = std::chrono::seconds(2);
/// Maximum number of accepted requests that wait for take(); further ones stay in the reader, which
/// keeps the last of each controller.
constexpr std::size_t kWaitingRequests = 256;

} // namespace

std::optional<EditRequest> request_from(const tactus_v5_EditRequests& wire)
{
    EditRequest request;
    request.controller = controller_of(wire);
    request.server_epoch = wire.server_epoch;
    request.model = wire.model;
    request.serial = wire.serial;
    request.kind = static_cast<EditKind>(wire.kind);
    request.radius_m = wire.radius_m;
    std::ranges::copy(wire.half_axis_m, request.half_axis_m.begin());
    for (std::uint32_t i = 0; i < wire.hull._length; ++i)
    {
        std::ranges::copy(wire.hull._buffer[i].place_m, request.hull_m.emplace_back().begin());
    }
    request.from = from_wire(wire.from);
    request.to = from_wire(wire.to);
    request.amount_m = wire.amount_m;
    if (!is_sound(request))
    {
        return std::nullopt;
    }
    request.from = checked_pose(request.from).value();
    request.to = checked_pose(request.to).value();
    return request;
}

std::uint32_t most_sum_parts(const ModelCounts& counts, std::uint32_t room) noexcept
{
    // A step is full, or it is the last one of the added faces or of a box.
    const std::uint64_t parts = std::uint64_t{room} / kMaxSumFaces +
                                std::uint64_t{counts.face_ids()} / kMaxSumFaces + kMaxRemovedBoxes +
                                2;
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(parts, kMaxSumParts));
}

Result<std::unique_ptr<EditPublisher>, Refusal>
EditPublisher::create(const Domain& domain, std::vector<Model> models, Editors editors)
{
    const std::string partition = server_partition(domain.participants().own_epoch());
    auto edits = make_writer(domain, Topic::edits, partition);
    if (!edits)
    {
        return edits.error();
    }
    auto requests = make_reader(domain, Topic::edit_requests, partition);
    if (!requests)
    {
        return requests.error();
    }
    std::unique_ptr<EditPublisher> publisher(
        new EditPublisher(domain, std::move(models), std::move(editors)));
    publisher->edits_ = std::move(edits).value();
    publisher->requests_ = std::move(requests).value();
    publisher->step(); // The empty sums show that this server has no edits.
    return publisher;
}

EditPublisher::EditPublisher(const Domain& domain, std::vector<Model> models, Editors editors)
    : domain_(&domain), editors_(std::move(editors))
{
    for (const Model& model : models)
    {
        models_.push_back({model, EditState(model.header.counts(), model.room)});
    }
}

std::optional<Refusal> EditPublisher::publish(std::uint32_t model,
                                              std::span<const EditContent> edits)
{
    if (state(model) == nullptr)
    {
        return Refusal{fmt::format("model {} can't be edited", model)};
    }
    Edited& edited = models_[model];
    for (const EditContent& edit : edits)
    {
        if (auto fault = edited.state.fault_of(edit))
        {
            return fault;
        }
        const std::size_t faces =
            edited.state.removed_count() + edit.removed.size() + edited.state.room();
        if (faces / kMaxSumFaces + kMaxRemovedBoxes + 2 > kMaxSumParts)
        {
            return Refusal{fmt::format("edit {} is refused: more than {} faces were removed since "
                                       "the start; save the model and serve it again",
                                       edit.revision, edited.state.removed_count())};
        }
        encode_edit(edit, edited.model.header, coded_);
        if (const auto decoded = decode_edit(coded_, edited.model.header); !decoded)
        {
            return decoded.error();
        }
        edited.state.apply(edit);
        edited.last_edit = Clock::now();
        ++counters_.edits;
        if (!try_write(model, edit.revision % kKeptEdits, edit.revision - 1, edit.revision, 0, 1))
        {
            edited.owes_sum = true;
        }
        if (edit.revision - edited.sum_to >= kKeptEdits)
        {
            write_sum(model);
        }
    }
    return std::nullopt;
}

std::optional<EditRequest> EditPublisher::take()
{
    read_requests();
    if (waiting_.empty())
    {
        return std::nullopt;
    }
    EditRequest request = std::move(waiting_.front());
    waiting_.pop_front();
    return request;
}

void EditPublisher::step()
{
    for (std::uint32_t model = 0; model < models_.size(); ++model)
    {
        const Edited& edited = models_[model];
        const bool is_old = edited.sum_to != edited.state.revision();
        if (edited.model.room > 0 &&
            (edited.owes_sum || (is_old && Clock::now() - edited.last_edit >= kSumAfterRest)))
        {
            write_sum(model);
        }
    }
}

const EditState* EditPublisher::state(std::uint32_t model) const
{
    return model < models_.size() && models_[model].model.room > 0 ? &models_[model].state
                                                                   : nullptr;
}

/// Writes `coded_` as the payload of one sample; false if the writer had no room.
bool EditPublisher::try_write(std::uint32_t model, std::uint32_t index, std::uint32_t from,
                              std::uint32_t to, std::uint32_t part, std::uint32_t parts)
{
    tactus_v5_Edits sample = {};
    sample.server_epoch = domain_->participants().own_epoch();
    sample.model = model;
    sample.index = index;
    sample.from = from;
    sample.to = to;
    sample.part = part;
    sample.parts = parts;
    const auto bytes = static_cast<std::uint32_t>(coded_.size());
    sample.payload = {bytes, bytes, reinterpret_cast<std::uint8_t*>(coded_.data()), false};
    counters_.bytes += bytes;
    return dds_write(edits_.handle, &sample) == DDS_RETCODE_OK;
}

/// Writes the edits that lead from the model of the file to its present surface. If a part can't be
/// written, a later step() writes all again.
void EditPublisher::write_sum(std::uint32_t model)
{
    Edited& edited = models_[model];
    const ModelHeader& header = edited.model.header;
    const EditState start(header.counts(), edited.model.room);
    std::vector<EditContent> steps = start.steps_to(edited.state, kMaxSumFaces);
    if (steps.empty())
    {
        steps.emplace_back().revision = 1; // A sum has at least one part.
    }
    TACTUS_ASSERT(steps.size() <= kMaxSumParts);
    const auto parts = static_cast<std::uint32_t>(steps.size());
    edited.owes_sum = true;
    for (std::uint32_t part = 0; part < parts; ++part)
    {
        encode_edit(steps[part], header, coded_);
        if (!try_write(model, kKeptEdits + part, 0, edited.state.revision(), part, parts))
        {
            return;
        }
    }
    edited.owes_sum = false;
    edited.sum_to = edited.state.revision();
    ++counters_.sums;
}

void EditPublisher::read_requests()
{
    Participants& participants = domain_->participants();
    while (waiting_.size() < kWaitingRequests)
    {
        const std::size_t taken = take_each<tactus_v5_EditRequests>(
            requests_.handle, kTakenAtOnce,
            [&](const tactus_v5_EditRequests& wire, const dds_sample_info_t& info)
            {
                if (!info.valid_data)
                {
                    return;
                }
                auto request = request_from(wire);
                if (!request || state(request->model) == nullptr || !may_edit(request->controller))
                {
                    ++counters_.requests_refused;
                    participants.refuse(info.publication_handle, Refused::edit_request, wire.model);
                    return;
                }
                ++counters_.requests;
                waiting_.push_back(*std::move(request));
            });
        if (taken < kTakenAtOnce)
        {
            return;
        }
    }
}

bool EditPublisher::may_edit(const ControllerId& controller) const
{
    return editors_.all ||
           std::ranges::any_of(editors_.names, [&](const std::string& name)
                               { return domain_->participants().is_called(controller, name); });
}

} // namespace tactus::dds
