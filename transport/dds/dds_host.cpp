// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/dds_host.hpp"

#include "platform/base/printable.hpp"
#include "transport/content_hash.hpp"
#include "transport/dds/take.hpp"
#include "transport/model_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "tactus.h"

namespace tactus::dds
{

namespace
{

/// The catalogue is written anew this often: after a stall a host may have been taken for dead.
constexpr auto kAnnouncement = std::chrono::seconds(1);
constexpr auto kLookAtDisputed = std::chrono::milliseconds(50);
/// Each has up to four DDS writers, about 400 KB.
constexpr std::size_t kMaxClients = 1'024;
/// Controllers that get all objects at the same time: many at once make each other lose what they
/// get, and it is sent again and again.
constexpr std::ptrdiff_t kMaxJoining = 2;
/// Who says nothing about its objects for so long has them, or has other troubles.
constexpr auto kJoiningMax = std::chrono::seconds(5);
/// It is told again that it may come in; the first time may have been before it listened.
constexpr auto kLetInAgain = std::chrono::milliseconds(100);
/// Lines a second of controllers that come and go.
constexpr std::uint32_t kVisitLines = 40;
/// Samples sent in one step, so that requests are looked at in between.
constexpr std::size_t kSamplesPerStep = 64;
constexpr std::size_t kRequestsPerStep = 1'024;
/// How long to wait while a controller's reader is not there yet.
constexpr auto kMatchWait = std::chrono::milliseconds(2);

/// What a controller calls itself, fit to be printed.
std::string name_of(const tactus_v4_Wanted& wanted)
{
    return printable(text_of(wanted.controller_name));
}

} // namespace

Result<std::unique_ptr<DdsHost>, Refusal> DdsHost::create(std::uint32_t domain,
                                                          std::vector<PublishedModel> models,
                                                          Log log, std::string scene)
{
    if (models.size() > kMaxModels)
    {
        return Refusal{
            fmt::format("{} models; a host serves at most {}", models.size(), kMaxModels)};
    }
    auto joined = Domain::join(domain);
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
    std::unique_ptr<DdsHost> host(new DdsHost(std::move(joined).value(), std::move(served),
                                              std::move(log), std::move(scene)));
    if (auto done = host->open_endpoints(); !done)
    {
        return done.error();
    }
    return host;
}

DdsHost::DdsHost(Domain domain, std::vector<ModelPieces> models, Log log, std::string scene)
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

void DdsHost::wait(std::chrono::milliseconds timeout)
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

void DdsHost::step()
{
    take_requests();
    if (Clock::now() - last_looked_ >= kLookAtDisputed)
    {
        look_for_gone(false);
    }
    let_in();
    serve();
    objects_->step();
    if (Clock::now() - last_announced_ >= kAnnouncement)
    {
        announce();
    }
}

DdsHost::Counters DdsHost::counters() const
{
    Counters counters = counters_;
    for (const Client& client : clients_)
    {
        counters.pieces_sent += client.subscription.pieces_sent();
        counters.bytes_sent += client.subscription.bytes_sent();
    }
    return counters;
}

std::vector<DdsHost::Subscriber> DdsHost::subscribers() const
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

Result<Done, Refusal> DdsHost::open_endpoints()
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
    announce(); // Last: who sees the announcement finds everything else.
    return Done{};
}

void DdsHost::announce()
{
    domain_.participants().report(fault_log_);
    look_for_gone(true);
    for (std::uint32_t i = 0; i < models_.size(); ++i)
    {
        const ModelStore& store = models_[i].store();
        const HeaderFields& fields = store.header().fields();
        tactus_v4_CatalogueEntry entry = {};
        entry.host_epoch = epoch_;
        entry.model = i;
        models_[i].model().name.copy(static_cast<char*>(entry.name), kMaxNameBytes);
        scene_.copy(static_cast<char*>(entry.scene), kMaxNameBytes);
        std::memcpy(entry.model_hash, store.hash().data(), store.hash().size());
        entry.faces = fields.source_faces;
        entry.header_bytes = static_cast<std::uint32_t>(store.header_bytes().size());
        entry.base_bytes = static_cast<std::uint32_t>(store.coded_bytes({ContentKind::base, 0}));
        dds_write(catalogue_.handle, &entry); // A failure is made good in the next second.
    }
    last_announced_ = Clock::now();
}

void DdsHost::take_requests()
{
    take_each<tactus_v4_Wanted>(
        wanted_.handle, kRequestsPerStep,
        [this](const tactus_v4_Wanted& wanted, const dds_sample_info_t& info)
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
        });
}

void DdsHost::on_request(const ControllerId& controller, const tactus_v4_Wanted& wanted)
{
    Client* client = find(controller);
    client = client == nullptr ? add_client(controller, wanted) : client;
    if (client == nullptr)
    {
        refuse(controller, Refused::controller);
        return;
    }
    client->subscription.set_credit({wanted.seen, wanted.granted, wanted.received});
    if (wanted.objects == 1)
    {
        const bool is_new =
            client->joining == Joining::not_wanted || client->joining == Joining::done;
        client->joining = is_new ? Joining::waits : client->joining;
        if (client->joining == Joining::under_way && Clock::now() - client->let_in > kLetInAgain)
        {
            client->subscription.let_in(epoch_);
        }
    }
    else
    {
        client->joining = wanted.objects == 0 ? Joining::not_wanted : Joining::done;
    }
    take_wishes(*client, wanted);
}

void DdsHost::take_wishes(Client& client, const tactus_v4_Wanted& wanted)
{
    for (std::uint32_t i = 0; i < wanted.pieces._length; ++i)
    {
        const tactus_v4_PieceName& name = wanted.pieces._buffer[i];
        const ContentKey key{static_cast<ContentKind>(name.kind), name.number};
        if (name.model >= models_.size() || !models_[name.model].has(key))
        {
            refuse(client.subscription.controller(), Refused::wish);
            continue;
        }
        client.subscription.wish({name.model, key}, wanted.generation);
    }
}

void DdsHost::refuse(const ControllerId& controller, Refused reason)
{
    ++counters_.requests_refused;
    domain_.participants().refusals().count(controller, reason);
}

DdsHost::Client* DdsHost::add_client(const ControllerId& controller, const tactus_v4_Wanted& wanted)
{
    const std::string name = name_of(wanted);
    if (!is_valid_name(name)) // It would name a partition.
    {
        fault_log_.write(fmt::format("controller '{}' is refused: its name is not 1 to 63 "
                                     "characters of A-Z a-z 0-9 . _ -",
                                     name));
        return nullptr;
    }
    if (clients_.size() == kMaxClients)
    {
        fault_log_.write(
            fmt::format("controller {} is refused: {} are the limit", name, kMaxClients));
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
    clients_.push_back({std::move(created).value()});
    visits_log_.write(fmt::format("controller {} subscribed{}", name,
                                  has_namesake ? "; another one of this name is here" : ""));
    return &clients_.back();
}

/// As in Catalogue: who isn't the controller can't end it, but makes its end be looked for.
void DdsHost::on_end(const ControllerId& controller, std::uint64_t writer)
{
    if (domain_.participants().writer_of(writer) == controller)
    {
        on_controller_gone(controller);
        return;
    }
    domain_.participants().refuse(writer, Refused::identity);
    if (Client* client = find(controller))
    {
        client->is_disputed = true;
    }
}

void DdsHost::look_for_gone(bool at_all)
{
    last_looked_ = Clock::now();
    std::vector<ControllerId> gone;
    for (const Client& client : clients_)
    {
        const ControllerId& controller = client.subscription.controller();
        if ((at_all || client.is_disputed) && !(domain_.participants().is_writing(client.writer) &&
                                                domain_.participants().is_here(controller)))
        {
            gone.push_back(controller);
        }
    }
    std::ranges::for_each(gone, [this](const ControllerId& each) { on_controller_gone(each); });
}

void DdsHost::on_controller_gone(const ControllerId& controller)
{
    const Client* client = find(controller);
    if (client == nullptr)
    {
        return;
    }
    const Subscription& subscription = client->subscription;
    counters_.pieces_sent += subscription.pieces_sent();
    counters_.bytes_sent += subscription.bytes_sent();
    visits_log_.write(fmt::format("controller {} left ({} pieces, {:.1f} KB sent)",
                                  subscription.controller_name(), subscription.pieces_sent(),
                                  static_cast<double>(subscription.bytes_sent()) / 1e3));
    clients_.erase(clients_.begin() + (client - clients_.data()));
}

void DdsHost::serve()
{
    std::size_t sent = 0;
    std::size_t idle = 0;
    while (sent < kSamplesPerStep && idle < clients_.size())
    {
        next_turn_ = (next_turn_ + 1) % clients_.size();
        const bool did =
            clients_[next_turn_].subscription.send_one(epoch_, models_, room_, fault_log_);
        sent += did ? 1U : 0U;
        idle = did ? 0 : idle + 1;
    }
    has_more_work_ = sent == kSamplesPerStep;
}

/// Two controllers at a time get all objects.
void DdsHost::let_in()
{
    const auto now = Clock::now();
    std::ptrdiff_t joining = std::ranges::count(clients_, Joining::under_way, &Client::joining);
    for (Client& client : clients_)
    {
        if (client.joining == Joining::under_way && now - client.let_in > kJoiningMax)
        {
            client.joining = Joining::done;
            --joining;
        }
        const bool is_next = client.joining == Joining::waits && joining < kMaxJoining;
        if (is_next && client.subscription.let_in(epoch_))
        {
            client.joining = Joining::under_way;
            client.let_in = now;
            ++joining;
        }
    }
}

DdsHost::Client* DdsHost::find(const ControllerId& controller)
{
    const auto client = std::ranges::find_if(
        clients_, [&](const Client& each) { return each.subscription.controller() == controller; });
    return client == clients_.end() ? nullptr : &*client;
}

} // namespace tactus::dds
