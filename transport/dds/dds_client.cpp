// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/dds_client.hpp"

#include "transport/content_hash.hpp"
#include "transport/dds/take.hpp"

#include <fmt/format.h>

#include <thread>
#include <utility>

#include "tactus.h"

namespace tactus::dds
{

/// One call's patience.
struct DdsClient::Wait
{
    using Clock = std::chrono::steady_clock;

    std::chrono::milliseconds timeout;
    const std::function<bool()>& go_on;
    Clock::time_point start{Clock::now()};

    /// Sleeps a little; false when it is over.
    [[nodiscard]] bool goes_on() const
    {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        return Clock::now() - start < timeout && (!go_on || go_on());
    }
    [[nodiscard]] std::string waited() const
    {
        const std::chrono::duration<double> passed = Clock::now() - start;
        return fmt::format("waited {:.3g} s", passed.count());
    }
};

namespace
{

/// Pieces that come before anybody has asked: none, but a link must be polled to get ready.
class NoSink final : public PieceSink
{
public:
    void receive(ContentKey /*key*/, std::span<const std::byte> /*bytes*/) override {}
};

void assign(std::vector<std::byte>& to, const dds_sequence_octet& from)
{
    const auto bytes = std::as_bytes(std::span(from._buffer, from._length));
    to.assign(bytes.begin(), bytes.end());
}

/// Why a header or base mesh must not be used; null when both are sound and of this hash.
const char* objection_to(const ServedModel& model)
{
    const auto header = parse_trusted_header(model.header);
    if (!header)
    {
        return refusal_text(header.error());
    }
    if (model_hash(model.header) != model.hash)
    {
        return refusal_text(SpmRefusal::wrong_identity);
    }
    return content_hash(model.base) == header.value().fields().base_hash
               ? nullptr
               : "has a base mesh of another hash than its header names";
}

} // namespace

Result<std::unique_ptr<DdsClient>, Refusal> DdsClient::create(std::uint32_t domain,
                                                              std::string controller_name, Log log)
{
    TACTUS_ASSERT(is_valid_name(controller_name));
    auto joined = Domain::join(domain);
    if (!joined)
    {
        return joined.error();
    }
    auto catalogue = Catalogue::create(joined.value(), log);
    if (!catalogue)
    {
        return catalogue.error();
    }
    return std::unique_ptr<DdsClient>(new DdsClient(std::move(joined).value(),
                                                    std::move(catalogue).value(),
                                                    std::move(controller_name), std::move(log)));
}

DdsClient::DdsClient(Domain domain, Catalogue catalogue, std::string controller_name, Log log)
    : domain_(std::move(domain))
    , catalogue_(std::move(catalogue))
    , controller_name_(std::move(controller_name))
    , log_(std::move(log))
{
}

Result<ServedModel, Refusal> DdsClient::find(const ModelSelector& selector,
                                             std::chrono::milliseconds timeout,
                                             const std::function<bool()>& go_on)
{
    const Wait wait{timeout, go_on};
    auto offer = wait_for_offer(selector, wait);
    if (!offer)
    {
        return offer.error();
    }
    ServedModel model;
    model.name = offer.value().name;
    model.hash = offer.value().hash;
    if (auto done = wait_for_start(offer.value(), wait, model); !done)
    {
        return done.error();
    }
    auto link = DdsLink::create(domain_, catalogue_, offer.value(), controller_name_, log_);
    if (!link)
    {
        return link.error();
    }
    if (auto done = wait_for_link(*link.value(), wait, model.name); !done)
    {
        return done.error();
    }
    model.link = std::move(link).value();
    return model;
}

Result<Catalogue::Offer, Refusal> DdsClient::wait_for_offer(const ModelSelector& selector,
                                                            const Wait& wait)
{
    bool has_said = false;
    do
    {
        catalogue_.refresh();
        if (const Catalogue::Offer* offer = catalogue_.find(selector); offer != nullptr)
        {
            return *offer;
        }
        if (!has_said && log_ && Wait::Clock::now() - wait.start > std::chrono::seconds(2))
        {
            log_(fmt::format("waiting for model '{}' on domain {}", selector.name, domain_.id()));
            has_said = true;
        }
    } while (wait.goes_on());
    const std::string pin = selector.hash ? "@" + hash_text(*selector.hash) : "";
    const Catalogue::Offer* other = catalogue_.find(ModelSelector{selector.name, std::nullopt});
    return Refusal{
        fmt::format("model '{}{}' is not published on domain {} ({}; published there: {}{})",
                    selector.name, pin, domain_.id(), wait.waited(), catalogue_.names(),
                    other != nullptr ? ", with hash " + hash_text(other->hash) : "")};
}

Result<Done, Refusal> DdsClient::wait_for_start(const Catalogue::Offer& offer, const Wait& wait,
                                                ServedModel& model)
{
    const std::string partition = model_partition(offer.hash);
    auto reader = make_reader(domain_, Topic::model, {&partition, 1});
    if (!reader)
    {
        return reader.error();
    }
    do
    {
        const char* objection = "";
        take_each<tactus_v1_ModelStart>(
            reader.value().handle, 16,
            [&](const tactus_v1_ModelStart& start, const dds_sample_info_t& info)
            {
                if (info.valid_data && (objection == nullptr || *objection == '\0'))
                {
                    assign(model.header, start.header);
                    assign(model.base, start.base);
                    objection = objection_to(model);
                }
            });
        if (objection == nullptr)
        {
            return Done{};
        }
        if (*objection != '\0')
        {
            return Refusal{fmt::format("model '{}' from domain {}: the header {}", offer.name,
                                       domain_.id(), objection)};
        }
    } while (wait.goes_on());
    return Refusal{fmt::format("model '{}' is published on domain {}, but its header did not come "
                               "({})",
                               offer.name, domain_.id(), wait.waited())};
}

Result<Done, Refusal> DdsClient::wait_for_link(DdsLink& link, const Wait& wait,
                                               const std::string& name)
{
    NoSink sink;
    do
    {
        link.poll(sink);
        if (link.is_ready())
        {
            return Done{};
        }
    } while (wait.goes_on());
    return Refusal{fmt::format("the host of model '{}' on domain {} does not answer ({})", name,
                               domain_.id(), wait.waited())};
}

} // namespace tactus::dds
