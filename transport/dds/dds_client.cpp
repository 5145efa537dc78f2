// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/dds_client.hpp"

#include "transport/base_fetch.hpp"
#include "transport/content_hash.hpp"
#include "transport/dds/dds_link.hpp"
#include "transport/dds/header_fetch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <thread>
#include <utility>

namespace tactus::dds
{

namespace
{

/// Between two looks.
constexpr auto kPause = std::chrono::milliseconds(1);
/// A model that isn't there after this long is spoken of.
constexpr auto kQuiet = std::chrono::seconds(2);

} // namespace

/// For one model.
struct DdsClient::Search
{
    ModelSelector selector;
    Catalogue::Offer offer;             ///< Once there is a fetch.
    std::unique_ptr<HeaderFetch> fetch; ///< Once it is published.
    bool is_done{false};
};

Result<std::unique_ptr<DdsClient>, Refusal> DdsClient::create(std::uint32_t domain,
                                                              std::string controller_name, Log log)
{
    TACTUS_ASSERT(is_valid_name(controller_name));
    auto joined = Domain::join(domain, Party::controller);
    if (!joined)
    {
        return joined.error();
    }
    auto catalogue = Catalogue::create(joined.value(), log);
    if (!catalogue)
    {
        return catalogue.error();
    }
    std::unique_ptr<DdsClient> client(new DdsClient(std::move(joined).value(),
                                                    std::move(catalogue).value(),
                                                    std::move(controller_name), std::move(log)));
    auto exchange =
        PieceExchange::create(client->domain_, client->catalogue_, client->controller_name_);
    if (!exchange)
    {
        return exchange.error();
    }
    client->exchange_ = std::move(exchange).value();
    return client;
}

DdsClient::DdsClient(Domain domain, Catalogue catalogue, std::string controller_name, Log log)
    : domain_(std::move(domain))
    , catalogue_(std::move(catalogue))
    , controller_name_(std::move(controller_name))
    , log_(std::move(log))
    , links_log_(log_)
{
}

Result<std::vector<ServedModel>, Refusal>
DdsClient::find_headers(std::span<const ModelSelector> selectors, std::chrono::milliseconds timeout,
                        const std::function<bool()>& go_on)
{
    using Clock = std::chrono::steady_clock;
    std::vector<Search> searches;
    for (const ModelSelector& selector : selectors)
    {
        searches.emplace_back().selector = selector;
    }
    const auto start = Clock::now();
    bool has_said = false;
    for (auto open = searches.begin(); open != searches.end();)
    {
        exchange_->step();
        for (Search& search : searches)
        {
            if (const auto refusal = step(search))
            {
                return *refusal;
            }
        }
        open = std::ranges::find(searches, false, &Search::is_done);
        const auto waited = Clock::now() - start;
        if (open == searches.end())
        {
            break;
        }
        if (waited >= timeout || (go_on && !go_on()))
        {
            const std::chrono::duration<double> seconds = waited;
            return not_found(*open, fmt::format("waited {:.3g} s", seconds.count()));
        }
        if (!has_said && log_ && waited > kQuiet && open->fetch == nullptr)
        {
            log_(fmt::format("waiting for model '{}' on domain {}", open->selector.name,
                             domain_.id()));
            has_said = true;
        }
        std::this_thread::sleep_for(kPause);
    }
    std::vector<ServedModel> models;
    for (Search& search : searches)
    {
        ServedModel& model = models.emplace_back();
        model.name = search.offer.name;
        model.hash = search.offer.hash;
        model.header = std::move(search.fetch->header());
        model.link =
            std::make_unique<DdsLink>(*exchange_, catalogue_, search.offer,
                                      [this](const std::string& text) { links_log_.write(text); });
    }
    return models;
}

Result<ServedModel, Refusal> DdsClient::find(const ModelSelector& selector,
                                             std::chrono::milliseconds timeout,
                                             const std::function<bool()>& go_on)
{
    auto models = find_headers({&selector, 1}, timeout, go_on);
    if (!models)
    {
        return models.error();
    }
    if (const auto refusal = bring_bases(models.value(), timeout, go_on))
    {
        return *refusal;
    }
    return std::move(models.value().front());
}

/// What is to be done for it now; a refusal ends all.
std::optional<Refusal> DdsClient::step(Search& search)
{
    if (search.fetch == nullptr)
    {
        const Catalogue::Offer* offer = catalogue_.find(search.selector);
        if (offer == nullptr)
        {
            return std::nullopt;
        }
        search.offer = *offer;
        search.fetch = std::make_unique<HeaderFetch>(*exchange_, catalogue_, *offer);
    }
    const auto state = search.fetch->step();
    search.is_done = state == HeaderFetch::State::done;
    if (state == HeaderFetch::State::refused)
    {
        return Refusal{fmt::format("model '{}' from domain {} {}", search.offer.name, domain_.id(),
                                   search.fetch->objection())};
    }
    return std::nullopt;
}

Refusal DdsClient::not_found(const Search& search, const std::string& waited) const
{
    const ModelSelector& selector = search.selector;
    if (search.fetch != nullptr)
    {
        return {fmt::format("model '{}' is published on domain {}, but its header did not come "
                            "({})",
                            selector.name, domain_.id(), waited)};
    }
    const std::string pin = selector.hash ? "@" + hash_text(*selector.hash) : "";
    const Catalogue::Offer* other = catalogue_.find(ModelSelector{selector.name, std::nullopt});
    return {fmt::format("model '{}{}' is not published on domain {} ({}; published there: {}{})",
                        selector.name, pin, domain_.id(), waited, catalogue_.names(),
                        other != nullptr ? ", with hash " + hash_text(other->hash) : "")};
}

} // namespace tactus::dds
