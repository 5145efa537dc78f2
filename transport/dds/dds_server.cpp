// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/dds_server.hpp"

#include "transport/base/printable.hpp"
#include "transport/content_hash.hpp"
#include "transport/dds/take.hpp"
#include "transport/model_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <tuple>
#include <utility>

#include "tactus.h"

namespace tactus::dds
{

namespace
{

/// Interval of announce(), which also reaches controllers that took a stalled server for gone.
constexpr auto kAnnouncement = std::chrono::seconds(1);
constexpr auto kLookForGone = std::chrono::milliseconds(50);
/// Number of calls of remove_gone_controllers() in which each controller is checked once.
constexpr std::size_t kLooks = 20;
/// Maximum number of controllers; each has up to four DDS writers, about 400 KB.
constexpr std::size_t kMaxClients = 1'024;
/// Maximum number of controllers that receive all objects at the same time. More of them make each
/// other lose samples.
constexpr std::size_t kMaxJoining = 2;
/// Time after its admission at which a controller counts as joined, so that it does not block
/// others; the second value applies if others wait. Sending 4,096 objects takes about 50 ms.
constexpr auto kJoiningMax = std::chrono::seconds(5);
constexpr auto kJoiningMaxBeforeOthers = std::chrono::seconds(1);
/// Interval at which an admission is repeated, since the controller's reader may have missed it.
constexpr auto kAdmitAgain = std::chrono::milliseconds(100);
/// Maximum number of log lines a second about controllers that arrive or leave.
constexpr std::uint32_t kVisitLines = 40;
/// Time limits for requests and for pieces in one step, so that poses go out every 10 ms under any
/// load. The rest waits for the next step. Cyclone keeps the last 16 requests of each controller.
constexpr auto kRequestsMax = std::chrono::milliseconds(2);
constexpr auto kServingMax = std::chrono::milliseconds(4);
/// Maximum number of pieces that one process may request in a second. A controller repeats up to
/// 256 requests four times a second; 256 models' headers of 64 parts each are requested ten times.
constexpr std::uint64_t kAskedMax = 262'144;
/// Half-life of the counts of recently sent bytes, which determine the order of service.
constexpr auto kHalfLife = std::chrono::milliseconds(250);
/// Cost of a sample in the order of service, in bytes, in addition to its pieces.
constexpr double kASample = 1'000.0;
/// Maximum wait while a controller with requests has no reader for pieces yet.
constexpr auto kMatchWait = std::chrono::milliseconds(2);

/// Controller's name in a request, made printable.
std::string name_of(const tactus_v5_Wanted& wanted)
{
    return printable(text_of(wanted.controller_name));
}

} // namespace

Result<std::unique_ptr<DdsServer>, Refusal> DdsServer::create(const DomainChoice& domain,
                                                              std::vector<PublishedModel> models,
                                                              Log log, std::string scene,
                                                              Party party, Editors editors)
{
    if (models.size() > kMaxModels)
    {
        return Refusal{
            fmt::format("{} models; a server serves at most {}", models.size(), kMaxModels)};
    }
    auto joined = Domain::join(domain, party);
    if (!joined)
    {
        return joined.error();
    }
    std::vector<ModelPieces> served;
    for (PublishedModel& model : models)
    {
        auto pieces = ModelPieces::create(std::move(model));
        if (!pieces)
        {
            return pieces.error();
        }
        served.push_back(std::move(pieces).value());
    }
    std::unique_ptr<DdsServer> server(new DdsServer(std::move(joined).value(), std::move(served),
                                                    std::move(log), std::move(scene)));
    if (auto done = server->open_endpoints(std::move(editors)); !done)
    {
        return done.error();
    }
    return server;
}

DdsServer::DdsServer(Domain domain, std::vector<ModelPieces> models, Log log, std::string scene)
    : domain_(std::move(domain))
    , models_(std::move(models))
    , scene_(std::move(scene))
    , visits_log_(log, kVisitLines)
    , fault_log_(std::move(log))
    , epoch_(domain_.participants().own_epoch())
{
    room_.payload.reserve(kPayloadBytes);
    room_.piece.reserve(kPartBytes);
}

void DdsServer::wait(std::chrono::milliseconds timeout)
{
    if (has_more_work_)
    {
        return;
    }
    const bool waits_for_match =
        std::any_of(clients_.begin(), clients_.end(),
                    [](const Client& client)
                    { return client.subscription.has_work() || client.joining == Joining::waits; });
    std::chrono::nanoseconds longest =
        waits_for_match ? std::min<std::chrono::nanoseconds>(timeout, kMatchWait) : timeout;
    const auto beat = objects_->next_beat();
    if (beat != Clock::time_point::max())
    {
        longest = std::clamp<std::chrono::nanoseconds>(beat - Clock::now(), {}, longest);
    }
    dds_waitset_wait(waitset_.get(), nullptr, 0, longest.count());
}

void DdsServer::step()
{
    ++steps_;
    has_more_work_ = false;
    objects_->step();
    if (edits_ != nullptr)
    {
        edits_->step();
    }
    take_requests(Clock::now() + kRequestsMax);
    const auto now = Clock::now();
    if (now - last_looked_ >= kLookForGone)
    {
        last_looked_ = now;
        remove_gone_controllers();
        static_cast<void>(std::ranges::find_if(clients_, [this](Client& client)
                                               // At most one controller a step.
                                               { return try_heal(client); }));
    }
    if (now - last_forgot_ >= kHalfLife)
    {
        last_forgot_ = now;
        forget();
    }
    admit_waiting();
    serve(now + kServingMax);
    if (Clock::now() - last_announced_ >= kAnnouncement)
    {
        announce();
    }
    objects_->step();
}

DdsServer::Counters DdsServer::counters() const
{
    Counters counters = counters_;
    for (const Client& client : clients_)
    {
        counters.pieces_sent += client.subscription.pieces_sent();
        counters.bytes_sent += client.subscription.bytes_sent();
    }
    return counters;
}

std::vector<DdsServer::Subscriber> DdsServer::subscribers() const
{
    std::vector<Subscriber> list;
    for (const Client& client : clients_)
    {
        const Subscription& subscription = client.subscription;
        list.push_back({subscription.controller_name(), subscription.pieces_sent(),
                        subscription.bytes_sent()});
    }
    return list;
}

Result<Done, Refusal> DdsServer::open_endpoints(Editors editors)
{
    std::vector<ContentHash> hashes;
    for (const ModelPieces& model : models_)
    {
        hashes.push_back(model.store().hash());
    }
    auto objects = ObjectPublisher::create(domain_, std::move(hashes));
    if (!objects)
    {
        return objects.error();
    }
    objects_ = std::move(objects).value();
    auto wanted = make_reader(domain_, Topic::wanted, kAnyPartition);
    if (!wanted)
    {
        return wanted.error();
    }
    wanted_ = std::move(wanted).value();
    auto catalogue = make_writer(domain_, Topic::catalogue, "");
    if (!catalogue)
    {
        return catalogue.error();
    }
    catalogue_ = std::move(catalogue).value();
    waitset_ = Entity(dds_create_waitset(domain_.participant()));
    dds_set_status_mask(wanted_.handle, DDS_DATA_AVAILABLE_STATUS);
    dds_waitset_attach(waitset_.get(), wanted_.handle, 0);
    if (auto done = open_edits(std::move(editors)); !done)
    {
        return done.error();
    }
    announce(); // Last, so that a controller that sees the announcement finds all else in place.
    return Done{};
}

/// Opens the topics of edits if a model can be edited.
Result<Done, Refusal> DdsServer::open_edits(Editors editors)
{
    std::vector<EditPublisher::Model> edited;
    bool has_room = false;
    for (const ModelPieces& each : models_)
    {
        const PublishedModel& model = each.model();
        if (model.edit_room > kMaxAddedFaces)
        {
            return Refusal{fmt::format("model '{}' has room for {} added faces; at most {} are "
                                       "allowed",
                                       model.name, model.edit_room, kMaxAddedFaces)};
        }
        edited.push_back({each.store().header(), model.edit_room});
        has_room = has_room || model.edit_room > 0;
    }
    if (!has_room)
    {
        return Done{};
    }
    auto edits = EditPublisher::create(domain_, std::move(edited), std::move(editors));
    if (!edits)
    {
        return edits.error();
    }
    edits_ = std::move(edits).value();
    const std::int32_t requests = edits_->requests_handle();
    dds_set_status_mask(requests, DDS_DATA_AVAILABLE_STATUS);
    dds_waitset_attach(waitset_.get(), requests, 0);
    return Done{};
}

void DdsServer::announce()
{
    domain_.participants().report(fault_log_);
    for (std::uint32_t i = 0; i < models_.size(); ++i)
    {
        const ModelStore& store = models_[i].store();
        const HeaderFields& fields = store.header().fields();
        tactus_v5_CatalogueEntry entry = {};
        entry.server_epoch = epoch_;
        entry.model = i;
        models_[i].model().name.copy(static_cast<char*>(entry.name), kMaxNameBytes);
        scene_.copy(static_cast<char*>(entry.scene), kMaxNameBytes);
        std::memcpy(entry.model_hash, store.hash().data(), store.hash().size());
        entry.faces = fields.source_faces;
        entry.header_bytes = static_cast<std::uint32_t>(store.header_bytes().size());
        entry.base_bytes = static_cast<std::uint32_t>(store.coded_bytes({ContentKind::base, 0}));
        entry.edit_room = models_[i].model().edit_room;
        dds_write(catalogue_.handle, &entry); // A failed write is repeated in the next second.
    }
    last_announced_ = Clock::now();
}

void DdsServer::take_requests(Clock::time_point end)
{
    const auto take = [this](const tactus_v5_Wanted& wanted, const dds_sample_info_t& info)
    {
        ControllerId controller{};
        std::memcpy(controller.data(), wanted.controller, sizeof(wanted.controller));
        if (tells_end(info))
        {
            on_end(controller, info.publication_handle);
            return;
        }
        ++counters_.requests;
        on_request(controller, wanted);
        if (Client* client = find(controller))
        {
            client->writer = info.publication_handle;
            client->is_disputed =
                client->is_disputed || info.instance_state != DDS_ALIVE_INSTANCE_STATE;
        }
    };
    while (take_each<tactus_v5_Wanted>(wanted_.handle, kTakenAtOnce, take) == kTakenAtOnce)
    {
        if (Clock::now() >= end)
        {
            has_more_work_ = true;
            return;
        }
    }
}

void DdsServer::on_request(const ControllerId& controller, const tactus_v5_Wanted& wanted)
{
    Client* client = find(controller);
    client = client == nullptr ? add_client(controller, wanted) : client;
    if (client == nullptr)
    {
        refuse(controller, Refused::controller);
        return;
    }
    client->subscription.requests().set_credit({wanted.seen, wanted.granted, wanted.received});
    if (wanted.objects == 1)
    {
        const bool is_new =
            client->joining == Joining::not_wanted || client->joining == Joining::done;
        client->joining = is_new ? Joining::waits : client->joining;
        if (client->joining == Joining::under_way && Clock::now() - client->admitted > kAdmitAgain)
        {
            client->subscription.admit(epoch_);
        }
    }
    else
    {
        client->joining = wanted.objects == 0 ? Joining::not_wanted : Joining::done;
    }
    if (wanted.objects == 3)
    {
        renew_motion(*client);
    }
    take_requests(*client, wanted);
}

/// Handles a controller that receives no motion although the server is present. A packet with a
/// much later sample number in a writer's name, perhaps forged, makes readers drop the writer's
/// samples.
void DdsServer::renew_motion(Client& client)
{
    const auto now = Clock::now();
    if (client.motion_renewals.is_due(now) && objects_->try_renew_motion(now))
    {
        client.motion_renewals.begin(now);
        ++counters_.renewed;
        fault_log_.write(fmt::format("controller {} receives no motion: a new writer sends it now",
                                     client.subscription.controller_name()));
    }
}

bool DdsServer::try_heal(Client& client)
{
    auto old = client.subscription.try_heal(Clock::now());
    if (old == nullptr)
    {
        return false;
    }
    domain_.disposal().dispose(std::move(old));
    ++counters_.renewed;
    fault_log_.write(fmt::format("pieces don't reach controller {}: new writers send them now",
                                 client.subscription.controller_name()));
    return true;
}

void DdsServer::take_requests(Client& client, const tactus_v5_Wanted& wanted)
{
    const std::uint32_t asked = wanted.pieces._length;
    client.process->asked += asked;
    if (client.process->asked > kAskedMax)
    {
        refuse(client.subscription.controller(), Refused::rate);
        return;
    }
    const std::uint32_t refused = client.subscription.requests().take(wanted, models_);
    for (std::uint32_t i = 0; i < refused; ++i)
    {
        refuse(client.subscription.controller(), Refused::request);
    }
}

void DdsServer::refuse(const ControllerId& controller, Refused reason)
{
    ++counters_.requests_refused;
    domain_.participants().refusals().count(controller, reason);
}

DdsServer::Client* DdsServer::add_client(const ControllerId& controller,
                                         const tactus_v5_Wanted& wanted)
{
    const std::string name = name_of(wanted);
    if (!is_valid_name(name)) // The name becomes a partition.
    {
        fault_log_.write(
            fmt::format("controller '{}' is refused: its name is not {}", name, kNameForm));
        return nullptr;
    }
    if (clients_.size() == kMaxClients)
    {
        fault_log_.write(fmt::format("controller {} is refused: at most {} controllers are served",
                                     name, kMaxClients));
        return nullptr;
    }
    auto created = Subscription::create(domain_, controller, name, wanted.seen);
    if (!created)
    {
        fault_log_.write(created.error().text);
        return nullptr;
    }
    const bool has_namesake =
        std::ranges::any_of(clients_, [&](const Client& client)
                            { return client.subscription.controller_name() == name; });
    const std::string program = domain_.participants().name_of(controller);
    auto process = std::ranges::find(
        processes_, program, [](const auto& known) -> const std::string& { return known->name; });
    if (process == processes_.end())
    {
        process = processes_.insert(process, std::make_shared<Process>(Process{program}));
    }
    clients_.push_back({std::move(created).value(), *process});
    visits_log_.write(fmt::format("controller {} subscribed{}", name,
                                  has_namesake ? "; another controller has this name" : ""));
    return &clients_.back();
}

/// Handles the end of a controller in DDS. Another program cannot end the controller, but triggers
/// a check. A controller that is silent, or loses one of several writers, stays until its lease
/// ends.
void DdsServer::on_end(const ControllerId& controller, std::uint64_t writer)
{
    Participants& participants = domain_.participants();
    const bool is_its_own = participants.writer_of(writer) == controller;
    if (!is_its_own)
    {
        participants.refuse(writer, Refused::identity);
    }
    Client* client = find(controller);
    if (client != nullptr && is_its_own && !participants.is_writing(client->writer))
    {
        on_controller_gone(controller);
    }
    else if (client != nullptr)
    {
        client->is_disputed = true;
    }
}

void DdsServer::remove_gone_controllers()
{
    std::vector<ControllerId> gone;
    const std::size_t turn_end = looked_at_ + clients_.size() / kLooks + 1;
    for (std::size_t i = 0; i < clients_.size(); ++i)
    {
        const Client& client = clients_[i];
        const ControllerId& controller = client.subscription.controller();
        const bool is_its_turn = i >= looked_at_ && i < turn_end;
        if ((is_its_turn || client.is_disputed) &&
            !(domain_.participants().is_writing(client.writer) &&
              domain_.participants().is_resident(controller)))
        {
            gone.push_back(controller);
        }
    }
    looked_at_ = turn_end < clients_.size() ? turn_end : 0;
    std::ranges::for_each(gone, [this](const ControllerId& each) { on_controller_gone(each); });
}

void DdsServer::on_controller_gone(const ControllerId& controller)
{
    Client* client = find(controller);
    if (client == nullptr)
    {
        return;
    }
    Subscription& subscription = client->subscription;
    counters_.pieces_sent += subscription.pieces_sent();
    counters_.bytes_sent += subscription.bytes_sent();
    visits_log_.write(fmt::format("controller {} left ({} pieces, {:.1f} KB sent)",
                                  subscription.controller_name(), subscription.pieces_sent(),
                                  static_cast<double>(subscription.bytes_sent()) / 1e3));
    domain_.disposal().dispose(std::make_shared<Subscription>(std::move(subscription)));
    clients_.erase(clients_.begin() + (client - clients_.data()));
}

/// Halves the counts of recent bytes, lowers those of requested pieces by a quarter, and removes
/// processes without controllers. Called every kHalfLife.
void DdsServer::forget()
{
    constexpr auto kTimesInASecond = std::chrono::seconds(1) / kHalfLife;
    std::erase_if(processes_, [](const auto& process) { return process.use_count() == 1; });
    for (const auto& process : processes_)
    {
        process->asked -= process->asked / kTimesInASecond;
        process->got_bytes /= 2.0;
    }
    for (Client& client : clients_)
    {
        client.got_bytes /= 2.0;
    }
}

/// Controller with the fewest recent bytes, in the process with the fewest; null if no controller
/// can be sent more in this step.
DdsServer::Client* DdsServer::next_to_serve()
{
    Client* next = nullptr;
    for (Client& client : clients_)
    {
        if (client.passed == steps_ || !client.subscription.has_work())
        {
            continue;
        }
        const auto got = [](const Client& who)
        { return std::pair(who.process->got_bytes, who.got_bytes); };
        next = next == nullptr || got(client) < got(*next) ? &client : next;
    }
    return next;
}

void DdsServer::serve(Clock::time_point end)
{
    while (Client* client = next_to_serve())
    {
        if (Clock::now() >= end)
        {
            has_more_work_ = true;
            return;
        }
        Subscription& subscription = client->subscription;
        const std::uint64_t sent_before = subscription.bytes_sent();
        if (!subscription.send_one(epoch_, models_, room_, fault_log_))
        {
            client->passed = steps_;
            continue;
        }
        const auto bytes = static_cast<double>(subscription.bytes_sent() - sent_before) + kASample;
        client->got_bytes += bytes;
        client->process->got_bytes += bytes;
    }
}

/// Admits waiting controllers while fewer than kMaxJoining receive objects. Controllers of the
/// processes with the fewest such receivers go first, then those with the oldest admission.
void DdsServer::admit_waiting()
{
    const auto now = Clock::now();
    const bool do_others_wait =
        std::ranges::find(clients_, Joining::waits, &Client::joining) != clients_.end();
    const auto longest = do_others_wait ? kJoiningMaxBeforeOthers : kJoiningMax;
    std::vector<const Process*> under_way;
    std::vector<Client*> waiting;
    for (Client& client : clients_)
    {
        if (client.joining == Joining::under_way && now - client.admitted > longest)
        {
            client.joining = Joining::done;
        }
        if (client.joining == Joining::under_way)
        {
            under_way.push_back(client.process.get());
        }
        if (client.joining == Joining::waits)
        {
            waiting.push_back(&client);
        }
    }
    std::ranges::stable_sort(waiting, {},
                             [&](const Client* client)
                             {
                                 const Process* process = client->process.get();
                                 return std::tuple(std::ranges::count(under_way, process),
                                                   process->admitted, client->admitted);
                             });
    for (Client* client : waiting)
    {
        if (under_way.size() == kMaxJoining)
        {
            break;
        }
        if (client->subscription.admit(epoch_))
        {
            client->joining = Joining::under_way;
            client->admitted = client->process->admitted = now;
            under_way.push_back(client->process.get());
        }
    }
}

DdsServer::Client* DdsServer::find(const ControllerId& controller)
{
    const auto client = std::ranges::find_if(
        clients_, [&](const Client& each) { return each.subscription.controller() == controller; });
    return client == clients_.end() ? nullptr : &*client;
}

} // namespace tactus::dds
