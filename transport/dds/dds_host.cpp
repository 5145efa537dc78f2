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
/// Subscriptions of all controllers together; each has up to four DDS writers, about 400 KB.
constexpr std::size_t kMaxSubscriptions = 1'024;
/// Samples sent in one step, so that requests are looked at in between.
constexpr std::size_t kSamplesPerStep = 64;
constexpr std::size_t kRequestsPerStep = 1'024;
/// How long to wait while a controller's reader is not there yet.
constexpr auto kMatchWait = std::chrono::milliseconds(2);

/// What a controller calls itself, fit to be printed.
std::string name_of(const tactus_v1_Wanted& wanted)
{
    const char* const text = static_cast<const char*>(wanted.controller_name);
    return printable({text, ::strnlen(text, sizeof(wanted.controller_name))});
}

} // namespace

struct DdsHost::Request
{
    ControllerId controller{};
    ContentHash hash{};
    const tactus_v1_Wanted& wanted;
};

Result<std::unique_ptr<DdsHost>, Refusal>
DdsHost::create(std::uint32_t domain, std::vector<PublishedModel> models, Log log)
{
    auto joined = Domain::join(domain);
    if (!joined)
    {
        return joined.error();
    }
    std::unique_ptr<DdsHost> host(
        new DdsHost(std::move(joined).value(), std::move(models), std::move(log)));
    if (auto done = host->open_endpoints(); !done)
    {
        return done.error();
    }
    return host;
}

DdsHost::DdsHost(Domain domain, std::vector<PublishedModel> models, Log log)
    : domain_(std::move(domain))
    , models_(std::move(models))
    , log_(log)
    , fault_log_(std::move(log))
    , epoch_(random_bits())
{
    payload_.reserve(kPayloadBytes);
    piece_.reserve(kMaxCodedChunkBytes);
}

void DdsHost::wait(std::chrono::milliseconds timeout)
{
    if (has_more_work_)
    {
        return;
    }
    const bool waits_for_match =
        std::any_of(subscriptions_.begin(), subscriptions_.end(),
                    [](const Subscription& subscription) { return subscription.has_work(); });
    const std::chrono::nanoseconds longest =
        waits_for_match ? std::min<std::chrono::nanoseconds>(timeout, kMatchWait) : timeout;
    dds_waitset_wait(waitset_.get(), nullptr, 0, longest.count());
}

void DdsHost::step()
{
    take_requests();
    serve();
    if (Clock::now() - last_announced_ >= kAnnouncement)
    {
        announce();
    }
}

DdsHost::Counters DdsHost::counters() const
{
    Counters counters = counters_;
    for (const Subscription& subscription : subscriptions_)
    {
        counters.pieces_sent += subscription.pieces_sent();
        counters.bytes_sent += subscription.bytes_sent();
    }
    return counters;
}

std::vector<DdsHost::Subscriber> DdsHost::subscribers() const
{
    std::vector<Subscriber> list;
    for (const Subscription& subscription : subscriptions_)
    {
        list.push_back({subscription.controller_name(), model_of(subscription.store().hash())->name,
                        subscription.pieces_sent(), subscription.bytes_sent()});
    }
    return list;
}

Result<Done, Refusal> DdsHost::open_endpoints()
{
    std::vector<std::string> partitions;
    for (const PublishedModel& model : models_)
    {
        partitions.push_back(model_partition(model.store.hash()));
        if (auto done = publish_start(model); !done)
        {
            return done;
        }
    }
    auto wanted = make_reader(domain_, Topic::wanted, partitions);
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

Result<Done, Refusal> DdsHost::publish_start(const PublishedModel& model)
{
    auto writer = make_writer(domain_, Topic::model, model_partition(model.store.hash()));
    if (!writer)
    {
        return writer.error();
    }
    std::vector<std::byte> base;
    if (auto done = model.store.read({ContentKind::base, 0}, base); !done)
    {
        return done.error();
    }
    const auto header = model.store.header_bytes();
    std::vector<std::byte> header_copy(header.begin(), header.end());
    const auto sequence = [](std::vector<std::byte>& bytes)
    {
        const auto length = static_cast<std::uint32_t>(bytes.size());
        return dds_sequence_octet{length, length, reinterpret_cast<std::uint8_t*>(bytes.data()),
                                  false};
    };
    tactus_v1_ModelStart start = {};
    std::memcpy(start.model_hash, model.store.hash().data(), model.store.hash().size());
    start.host_epoch = epoch_;
    start.header = sequence(header_copy);
    start.base = sequence(base);
    if (const auto code = dds_write(writer.value().handle, &start); code != DDS_RETCODE_OK)
    {
        return Refusal{fmt::format("model '{}' (header of {} bytes, base mesh of {}) cannot be "
                                   "published: {}",
                                   model.name, header.size(), base.size(), dds_strretcode(code))};
    }
    starts_.push_back(std::move(writer).value());
    return Done{};
}

void DdsHost::announce()
{
    for (const PublishedModel& model : models_)
    {
        const HeaderFields& fields = model.store.header().fields();
        tactus_v1_CatalogueEntry entry = {};
        model.name.copy(static_cast<char*>(entry.name), kMaxNameBytes);
        entry.host_epoch = epoch_;
        entry.protocol_version = kProtocolVersion;
        std::memcpy(entry.model_hash, model.store.hash().data(), model.store.hash().size());
        entry.revision = fields.revision;
        entry.faces = fields.source_faces;
        entry.header_bytes = fields.header_bytes;
        entry.base_bytes = fields.base_bytes;
        dds_write(catalogue_.handle, &entry); // A failure is made good in the next second.
    }
    last_announced_ = Clock::now();
}

void DdsHost::take_requests()
{
    take_each<tactus_v1_Wanted>(
        wanted_.handle, kRequestsPerStep,
        [this](const tactus_v1_Wanted& wanted, const dds_sample_info_t& info)
        {
            Request request{{}, {}, wanted};
            std::memcpy(request.controller.data(), wanted.controller, sizeof(wanted.controller));
            std::memcpy(request.hash.data(), wanted.model_hash, sizeof(wanted.model_hash));
            if (info.instance_state != DDS_ALIVE_INSTANCE_STATE)
            {
                on_controller_gone(request.controller, request.hash);
            }
            else if (info.valid_data && wanted.host_epoch == epoch_)
            {
                ++counters_.requests;
                on_request(request);
            }
        });
}

void DdsHost::on_request(const Request& request)
{
    const tactus_v1_Wanted& wanted = request.wanted;
    const PublishedModel* model = model_of(request.hash);
    if (wanted.protocol_version != kProtocolVersion)
    {
        ++counters_.requests_refused;
        fault_log_.write(fmt::format("controller {} is refused: it speaks protocol version {}, "
                                     "this build {}",
                                     name_of(wanted), wanted.protocol_version, kProtocolVersion));
        return;
    }
    if (model == nullptr || wanted.revision != model->store.revision())
    {
        ++counters_.requests_refused;
        return;
    }
    auto subscription = find(request.controller, request.hash);
    if (subscription == subscriptions_.end())
    {
        const std::string name = name_of(wanted);
        if (subscriptions_.size() == kMaxSubscriptions)
        {
            ++counters_.requests_refused;
            fault_log_.write(fmt::format("controller {} is refused: {} subscriptions are the limit",
                                         name, kMaxSubscriptions));
            return;
        }
        auto created =
            Subscription::create(domain_, model->store, request.controller, name, wanted.seen);
        if (!created)
        {
            fault_log_.write(created.error().text);
            return;
        }
        subscriptions_.push_back(std::move(created).value());
        subscription = subscriptions_.end() - 1;
        log_(fmt::format("controller {} subscribed to model '{}'", name, model->name));
    }
    subscription->set_credit({wanted.seen, wanted.granted, wanted.received});
    for (std::uint32_t i = 0; i < wanted.pieces._length; ++i)
    {
        const tactus_v1_PieceName piece = wanted.pieces._buffer[i];
        const ContentKey key{static_cast<ContentKind>(piece.kind), piece.number};
        const bool is_served = piece.kind == static_cast<std::uint32_t>(ContentKind::index_page) ||
                               piece.kind == static_cast<std::uint32_t>(ContentKind::chunk);
        if (!is_served || !model->store.has(key))
        {
            ++counters_.requests_refused;
            continue;
        }
        subscription->wish(key, wanted.generation);
    }
}

void DdsHost::on_controller_gone(const ControllerId& controller, const ContentHash& hash)
{
    const auto subscription = find(controller, hash);
    if (subscription == subscriptions_.end())
    {
        return;
    }
    counters_.pieces_sent += subscription->pieces_sent();
    counters_.bytes_sent += subscription->bytes_sent();
    log_(fmt::format("controller {} left model '{}' ({} pieces, {:.1f} KB sent)",
                     subscription->controller_name(), model_of(hash)->name,
                     subscription->pieces_sent(),
                     static_cast<double>(subscription->bytes_sent()) / 1e3));
    subscriptions_.erase(subscription);
}

void DdsHost::serve()
{
    std::size_t sent = 0;
    std::size_t idle = 0;
    while (sent < kSamplesPerStep && idle < subscriptions_.size())
    {
        next_turn_ = (next_turn_ + 1) % subscriptions_.size();
        const bool did = subscriptions_[next_turn_].send_one(epoch_, payload_, piece_, fault_log_);
        sent += did ? 1U : 0U;
        idle = did ? 0 : idle + 1;
    }
    has_more_work_ = sent == kSamplesPerStep;
}

const PublishedModel* DdsHost::model_of(const ContentHash& hash) const
{
    const auto at =
        std::find_if(models_.begin(), models_.end(),
                     [&](const PublishedModel& model) { return model.store.hash() == hash; });
    return at == models_.end() ? nullptr : &*at;
}

std::vector<Subscription>::iterator DdsHost::find(const ControllerId& controller,
                                                  const ContentHash& hash)
{
    return std::find_if(subscriptions_.begin(), subscriptions_.end(),
                        [&](const Subscription& subscription) {
                            return subscription.controller() == controller &&
                                   subscription.store().hash() == hash;
                        });
}

} // namespace tactus::dds
