// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/controller/server_topics.hpp"

#include "platform/controller/controller.hpp"
#include "platform/controller/cut_sender.hpp"
#include "platform/loop/edit_mailbox.hpp"
#include "platform/loop/scene_mailbox.hpp"
#include "platform/loop/telemetry_tap.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/frame/model.hpp"
#include "transport/base/printable.hpp"
#include "transport/chunk_loader.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/telemetry_from_frame.hpp"
#include "transport/waiting_times.hpp"

#include <algorithm>
#include <utility>

namespace tactus::hrtc
{

namespace
{

/// Reader of the edits of the servers' models with a room for them; null without any.
std::unique_ptr<dds::EditReader> edit_reader(const dds::DdsClient& client,
                                             const Controller& controller, Log log)
{
    std::vector<dds::EditReader::Model> models;
    for (std::size_t i = 0; i < controller.models().size(); ++i)
    {
        const ServedModel& model = controller.models()[i];
        const bool is_served = model.server_epoch != 0;
        models.push_back({model.name, model.hash, ModelHeader::parse(model.header).value(),
                          is_served ? controller.setup().models[i].capacities.edit_faces : 0});
    }
    const bool has_room =
        std::ranges::any_of(models, [](const auto& model) { return model.room > 0; });
    return has_room ? std::make_unique<dds::EditReader>(client.domain(), client.catalogue(),
                                                        std::move(models), std::move(log))
                    : nullptr;
}

} // namespace

Result<std::unique_ptr<ServerTopics>, Refusal>
ServerTopics::create(dds::DdsClient& client, const Controller& controller,
                     std::span<dds::Authority> authorities, std::unique_ptr<SceneKeeper> keeper,
                     bool shows_refinement_state, const Log& log)
{
    std::unique_ptr<ServerTopics> topics(
        new ServerTopics(client, controller, authorities, std::move(keeper), log));
    std::vector<ModelIdentity> identities;
    for (std::size_t i = 0; i < controller.models().size() && i < kMaxShownModels; ++i)
    {
        const ServedModel& model = controller.models()[i];
        const ModelHeader header = ModelHeader::parse(model.header).value();
        identities.push_back({model.name, model.hash, header.fields().revision});
    }
    auto telemetry = dds::TelemetryWriter::create(client.domain(), client.controller_name(),
                                                  std::move(identities));
    if (!telemetry)
    {
        return telemetry.error();
    }
    topics->telemetry_ = std::move(telemetry).value();
    topics->edits_ = edit_reader(client, controller, log);
    if (shows_refinement_state)
    {
        topics->states_.emplace(controller);
    }
    return topics;
}

ServerTopics::ServerTopics(const dds::DdsClient& client, const Controller& controller,
                           std::span<dds::Authority> authorities,
                           std::unique_ptr<SceneKeeper> keeper, const Log& log)
    : client_(client)
    , controller_(controller)
    , authorities_(authorities)
    , keeper_(std::move(keeper))
    , requests_(client.domain(), log)
    , seen_(controller.models().size())
{
    for (const ServedModel& model : controller.models())
    {
        origins_m_.push_back(ModelHeader::parse(model.header).value().origin_m());
    }
}

ServerTopics::~ServerTopics() = default;

void ServerTopics::connect(SceneMailbox& mailbox, EditMailbox* edits, TelemetryTap& tap,
                           RefinementStateTap* states, MonotonicTime now,
                           SceneKeeper::NameSink names)
{
    tap_ = &tap;
    TACTUS_ASSERT(edits != nullptr || edits_ == nullptr);
    edit_mailbox_ = edits;
    if (states_)
    {
        TACTUS_ASSERT(states != nullptr);
        states_->connect(*states);
    }
    if (keeper_ != nullptr)
    {
        keeper_->connect(mailbox, now,
                         [this, names = std::move(names)](std::uint32_t number,
                                                          std::uint32_t generation,
                                                          const std::string& name)
                         {
                             name_object(number, name);
                             if (names)
                             {
                                 names(number, generation, name);
                             }
                         });
    }
}

void ServerTopics::add_cuts(std::unique_ptr<CutSender> cuts) noexcept
{
    TACTUS_ASSERT(edits_ != nullptr);
    cuts_ = std::move(cuts);
}

CutTap* ServerTopics::cut_tap() noexcept
{
    return cuts_ != nullptr ? &cuts_->tap() : nullptr;
}

void ServerTopics::tell_begins_inside(std::size_t tool) noexcept
{
    if (states_)
    {
        states_->tell_begins_inside(tool);
    }
}

void ServerTopics::step(MonotonicTime now)
{
    for (dds::Authority& authority : authorities_)
    {
        authority.step();
    }
    if (keeper_ != nullptr)
    {
        keeper_->step(now);
    }
    if (edits_ != nullptr)
    {
        pass_edits();
    }
    if (cuts_ != nullptr)
    {
        cuts_->step([this](std::size_t model) { return edits_->counts(model).edits; },
                    [this](std::size_t model, EditRequest request)
                    { return try_request(model, std::move(request)); });
    }
    if (now - last_sent_ >= kTelemetryPeriod)
    {
        last_sent_ = now;
        is_renewed_ = false;
        send_telemetry(now);
    }
    else if (!is_renewed_ && now - last_sent_ >= kTelemetryPeriod - kRenewal)
    {
        is_renewed_ = true;
        renew_objects(false);
    }
}

std::vector<dds::PoseCounts> ServerTopics::pose_counts() const
{
    std::vector<dds::PoseCounts> counts;
    for (std::size_t i = 0; keeper_ != nullptr && i < controller_.models().size(); ++i)
    {
        counts.push_back(keeper_->counts(i));
    }
    return counts;
}

SceneNewsCounts ServerTopics::scene_news() const
{
    return keeper_ != nullptr ? keeper_->news() : SceneNewsCounts{};
}

std::vector<dds::ServerEvent> ServerTopics::server_events() const
{
    std::vector<dds::ServerEvent> events;
    for (const dds::Authority& authority : authorities_)
    {
        events.insert(events.end(), authority.events().begin(), authority.events().end());
    }
    std::ranges::stable_sort(events, {}, &dds::ServerEvent::time);
    return events;
}

std::vector<dds::PeerRefusals> ServerTopics::refused() const
{
    return client_.domain().participants().refusals().list();
}

std::vector<dds::EditReader::Counts> ServerTopics::edit_counts() const
{
    std::vector<dds::EditReader::Counts> counts;
    for (std::size_t i = 0; edits_ != nullptr && i < controller_.models().size(); ++i)
    {
        counts.push_back(edits_->counts(i));
    }
    return counts;
}

std::optional<CutCounts> ServerTopics::cut_counts() const
{
    return cuts_ != nullptr ? std::optional(cuts_->counts()) : std::nullopt;
}

/// Epoch of the server with authority over the model: that of the scene, or of the model; 0: none.
std::uint64_t ServerTopics::server_of(std::size_t model) const
{
    return authorities_.empty() ? 0
                                : authorities_[std::min(model, authorities_.size() - 1)].server();
}

/// Passes edits to the mailbox. Edits without room there are offered again in the next step.
void ServerTopics::pass_edits()
{
    if (const auto model = edit_mailbox_->take_refused_model())
    {
        edits_->end(model->value);
    }
    for (std::size_t i = 0; i < controller_.models().size(); ++i)
    {
        edits_->follow(i, server_of(i));
    }
    edits_->poll();
    for (std::uint32_t i = 0; i < controller_.models().size(); ++i)
    {
        const EditContent* edit = edits_->next(i);
        while (edit != nullptr && edit_mailbox_->try_put(ModelId{i}, *edit))
        {
            edits_->pop(i);
            edit = edits_->next(i);
        }
    }
}

/// Sends a request to the model's server; false if the model takes no edits or it can't be sent.
bool ServerTopics::try_request(std::size_t model, EditRequest request)
{
    const auto number = edits_->number_of(model);
    request.server_epoch = server_of(model);
    request.model = number.value_or(0);
    return number && request.server_epoch != 0 && requests_.try_send(std::move(request));
}

void ServerTopics::send_telemetry(MonotonicTime now)
{
    Telemetry telemetry;
    if (!tap_->try_read(telemetry))
    {
        return; // No frame has run yet.
    }
    for (std::size_t i = 0; i < telemetry.model_count; ++i)
    {
        add_transport_side(i, telemetry.models[i], now);
    }
    for (std::size_t i = 0; i < telemetry.pair_count; ++i)
    {
        name_server(telemetry.pairs[i].server_epoch, telemetry.pairs[i].object);
    }
    const std::optional<RefinementState> state =
        states_ ? states_->take(now, *telemetry_) : std::nullopt;
    telemetry_->write(telemetry, take_objects(), state ? &*state : nullptr);
}

void ServerTopics::add_transport_side(std::size_t model, ModelTelemetry& telemetry,
                                      MonotonicTime now)
{
    const WaitingTimes& waiting =
        controller_.chunk_loader().waiting_times(static_cast<std::uint32_t>(model));
    telemetry.server_gone = controller_.models()[model].link->state() == LinkState::server_gone;
    telemetry.pieces = waiting.total();
    Seen& seen = seen_[model];
    const auto news = static_cast<std::int64_t>(waiting.total() - seen.pieces);
    telemetry.piece_wait_ns = news > 0 ? (waiting.sum_ns() - seen.wait_ns) / news : 0;
    seen = {waiting.total(), waiting.sum_ns()};
    if (keeper_ != nullptr)
    {
        const dds::PoseCounts& counts = keeper_->counts(model);
        telemetry.follows_poses = counts.accepted > 0;
        telemetry.pose_age_ns = telemetry.follows_poses ? (now - keeper_->heard(model)).ns : 0;
        telemetry.poses_refused = counts.refused_in_all();
    }
}

/// Asks the haptic thread for new poses of the objects if there is a reader.
void ServerTopics::renew_objects(bool was_sent)
{
    const bool is_out = tap_->objects().take() != nullptr;
    if (is_out && telemetry_->is_watched())
    {
        tap_->objects().give_back(was_sent);
        has_new_objects_ = true;
    }
}

/// Newest poses of the objects; none without a reader.
ObjectsTelemetry ServerTopics::take_objects()
{
    ObjectsTelemetry shown;
    const ObjectsCopy* copy = tap_->objects().take();
    has_new_objects_ = has_new_objects_ && telemetry_->is_watched();
    const bool is_new = copy != nullptr && has_new_objects_;
    if (is_new)
    {
        shown.sweep_begin = copy->sweep_begin;
        shown.sweep_end = copy->sweep_end;
        const std::lock_guard lock(names_mutex_);
        for (const ObjectsCopy::Object& object : copy->objects)
        {
            const ServedModel& model = controller_.models()[object.model];
            const auto name = names_.find(object.number);
            ObjectTelemetry& told = shown.objects.emplace_back(
                ObjectTelemetry{0, object.number, object.number,
                                printable(name != names_.end() ? name->second : model.name),
                                model.hash, source_pose_of(object.pose, origins_m_[object.model])});
            name_server(told.server_epoch, told.object);
        }
    }
    renew_objects(is_new);
    return shown;
}

void ServerTopics::name_object(std::uint32_t number, const std::string& name)
{
    const std::lock_guard lock(names_mutex_);
    if (name.empty())
    {
        names_.erase(number); // The number may be that of a removed object.
        return;
    }
    names_[number] = name;
}

/// Replaces the controller's object number by the server's epoch and number, if a server shows the
/// object.
void ServerTopics::name_server(std::uint64_t& server_epoch, std::uint32_t& object) const
{
    if (const auto shown = keeper_ != nullptr ? keeper_->shown_as(object) : std::nullopt)
    {
        server_epoch = shown->server_epoch;
        object = shown->number;
    }
}

} // namespace tactus::hrtc
