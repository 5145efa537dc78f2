// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"
#include "transport/dds/catalogue.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/header_fetch.hpp"
#include "transport/dds/piece_exchange.hpp"
#include "transport/log.hpp"
#include "transport/model_name.hpp"
#include "transport/served_model.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tactus::dds
{

/// A controller on a DDS domain: finds models and makes links to them. One thread, the transport
/// thread, uses it and its links.
class DdsClient
{
public:
    /// `controller_name` is shown by hosts; a valid name (asserted). Join from an ordinary thread,
    /// and after a host of the same process, see Domain, which also says what is refused.
    [[nodiscard]] static Result<std::unique_ptr<DdsClient>, Refusal>
    create(std::uint32_t domain, std::string controller_name, Log log);

    /// Waits until all these models are published and their headers came, verified, each from the
    /// first of its servers that answers. What it returns, in the order of the selectors, has no
    /// base meshes: bring_bases() fetches them, or a courier those of guests. Waits at most
    /// `timeout`, or until `go_on` (asked every few milliseconds) returns false; then it is
    /// refused, as it is after a second where every server's header is damaged. The client must
    /// outlive the models' links.
    [[nodiscard]] Result<std::vector<ServedModel>, Refusal>
    find_headers(std::span<const ModelSelector> selectors, std::chrono::milliseconds timeout,
                 const std::function<bool()>& go_on = {});
    /// The same for one, with its base mesh.
    [[nodiscard]] Result<ServedModel, Refusal> find(const ModelSelector& selector,
                                                    std::chrono::milliseconds timeout,
                                                    const std::function<bool()>& go_on = {});

    [[nodiscard]] const Catalogue& catalogue() const noexcept { return catalogue_; }
    [[nodiscard]] Catalogue& catalogue() noexcept { return catalogue_; }
    /// For a SceneReader. Polling a link steps it; without links call its step().
    [[nodiscard]] PieceExchange& exchange() noexcept { return *exchange_; }
    /// For further topics of the same controller; lives as long as the client.
    [[nodiscard]] const Domain& domain() const noexcept { return domain_; }
    [[nodiscard]] const std::string& controller_name() const noexcept { return controller_name_; }

private:
    DdsClient(Domain domain, Catalogue catalogue, std::string controller_name, Log log);

    [[nodiscard]] ServedModel served(HeaderSearch& search);
    [[nodiscard]] Refusal not_found(const HeaderSearch& search, bool is_published,
                                    const std::string& waited) const;

    Domain domain_; ///< First, so that it is left last.
    Catalogue catalogue_;
    std::string controller_name_;
    Log log_;
    RateLimitedLog links_log_; ///< Of all links: a host that goes is that of many models.
    std::unique_ptr<PieceExchange> exchange_; ///< From create() on.
};

} // namespace tactus::dds
