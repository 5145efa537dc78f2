// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/dds_client.hpp"

#include "transport/base_fetch.hpp"
#include "transport/content_hash.hpp"
#include "transport/dds/dds_link.hpp"

#include <fmt/format.h>

#include <list>
#include <thread>
#include <utility>

namespace tactus::dds
{

namespace
{

/// Pause between two rounds of find_headers().
constexpr auto kPause = std::chrono::milliseconds(1);
/// Wait after which missing models are logged.
constexpr auto kQuiet = std::chrono::seconds(2);

} // namespace

Result<std::unique_ptr<DdsClient>, Refusal> DdsClient::create(const DomainChoice& domain,
                                                              std::string controller_name, Log log)
{
    auto joined = Domain::join(domain, Party::controller);
    if (!joined)
    {
        return joined.error();
    }
    if (const std::string& certified = joined.value().certificate(); !certified.empty())
    {
        if (!controller_name.empty() && controller_name != certified)
        {
            return Refusal{fmt::format("--name: '{}' can't be shown with the keys of '{}'",
                                       controller_name, certified)};
        }
        controller_name = certified;
    }
    TACTUS_ASSERT(is_valid_name(controller_name));
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
    std::list<HeaderSearch> searches;
    for (const ModelSelector& selector : selectors)
    {
        searches.emplace_back(*exchange_, catalogue_, selector);
    }
    const auto start = Clock::now();
    bool has_said = false;
    for (;;)
    {
        exchange_->step();
        const HeaderSearch* open = nullptr; // First search without a header.
        auto open_state = HeaderSearch::State::done;
        for (HeaderSearch& search : searches)
        {
            const auto state = search.step();
            if (state == HeaderSearch::State::refused)
            {
                return Refusal{fmt::format("model '{}' from domain {} {}", search.offer().name,
                                           domain_.id(), search.objection())};
            }
            if (state != HeaderSearch::State::done && open == nullptr)
            {
                open = &search;
                open_state = state;
            }
        }
        if (open == nullptr)
        {
            break;
        }
        const bool is_published = open_state == HeaderSearch::State::under_way;
        const auto waited = Clock::now() - start;
        if (waited >= timeout || (go_on && !go_on()))
        {
            const std::chrono::duration<double> seconds = waited;
            return not_found(*open, is_published, fmt::format("waited {:.3g} s", seconds.count()));
        }
        if (!has_said && log_ && waited > kQuiet && !is_published)
        {
            log_(fmt::format("waiting for model '{}' on domain {}", open->selector().name,
                             domain_.id()));
            has_said = true;
        }
        std::this_thread::sleep_for(kPause);
    }
    std::vector<ServedModel> models;
    for (HeaderSearch& search : searches)
    {
        models.push_back(served(search));
    }
    return models;
}

ServedModel DdsClient::served(HeaderSearch& search)
{
    ServedModel model;
    model.name = search.offer().name;
    model.hash = search.offer().hash;
    model.server_epoch = search.offer().server_epoch;
    model.edit_room = search.offer().edit_room;
    model.header = std::move(search.header());
    model.link =
        std::make_unique<DdsLink>(*exchange_, catalogue_, search.offer(),
                                  [this](const std::string& text) { links_log_.write(text); });
    return model;
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
    if (const auto refusal = fetch_base_meshes(models.value(), timeout, go_on))
    {
        return *refusal;
    }
    return std::move(models.value().front());
}

Refusal DdsClient::not_found(const HeaderSearch& search, bool is_published,
                             const std::string& waited) const
{
    const ModelSelector& selector = search.selector();
    if (is_published)
    {
        return {
            fmt::format("model '{}' is published on domain {}, but its header did not arrive ({})",
                        selector.name, domain_.id(), waited)};
    }
    const std::string pin = selector.hash             ? "@" + hash_text(*selector.hash)
                            : selector.server.empty() ? ""
                                                      : "@" + selector.server;
    const Catalogue::Offer* other = catalogue_.find({selector.name});
    const std::string names = catalogue_.names();
    const auto why = names == "none" ? why_unheard(domain_.id()) : std::nullopt;
    return {fmt::format("model '{}{}' is not published on domain {}{} ({}; published there: {}{})",
                        selector.name, pin, domain_.id(), why ? ": " + *why : "", waited, names,
                        other != nullptr
                            ? fmt::format(", with hash {} by {}", hash_text(other->hash),
                                          catalogue_.participants().name_of(other->server))
                            : "")};
}

} // namespace tactus::dds
