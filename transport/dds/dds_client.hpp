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

/// Connects a controller to a DDS domain: finds models and creates links to them. The client and
/// its links belong to one thread, the transport thread.
class DdsClient
{
public:
    /// Joins the domain, with the refusals of Domain::join(). Servers show `controller_name`, which
    /// must be valid (asserted); with keys it is the certificate's name and may be empty. Call it
    /// on an ordinary thread, and after a server of the same process joined.
    [[nodiscard]] static Result<std::unique_ptr<DdsClient>, Refusal>
    create(const DomainChoice& domain, std::string controller_name, Log log);

    /// Waits until all these models are published and their verified headers have arrived, each
    /// from the first of its servers that answers. Returns the models in the order of the
    /// selectors, without base meshes (fetch_base_meshes()). Refused after `timeout`, if `go_on`
    /// (called every few milliseconds) returns false, or if for a second every server of a model
    /// sends a wrong header. The client must outlive the links.
    [[nodiscard]] Result<std::vector<ServedModel>, Refusal>
    find_headers(std::span<const ModelSelector> selectors, std::chrono::milliseconds timeout,
                 const std::function<bool()>& go_on = {});
    /// Finds one model and fetches its base mesh too; otherwise like find_headers().
    [[nodiscard]] Result<ServedModel, Refusal> find(const ModelSelector& selector,
                                                    std::chrono::milliseconds timeout,
                                                    const std::function<bool()>& go_on = {});

    [[nodiscard]] const Catalogue& catalogue() const noexcept { return catalogue_; }
    [[nodiscard]] Catalogue& catalogue() noexcept { return catalogue_; }
    /// Exchange, for a SceneReader. Polling any link steps it; without links, call its step().
    [[nodiscard]] PieceExchange& exchange() noexcept { return *exchange_; }
    /// Domain for further topics of the same controller; lives as long as the client.
    [[nodiscard]] const Domain& domain() const noexcept { return domain_; }
    [[nodiscard]] const std::string& controller_name() const noexcept { return controller_name_; }

private:
    DdsClient(Domain domain, Catalogue catalogue, std::string controller_name, Log log);

    [[nodiscard]] ServedModel served(HeaderSearch& search);
    [[nodiscard]] Refusal not_found(const HeaderSearch& search, bool is_published,
                                    const std::string& waited) const;

    Domain domain_; ///< First member, so that it is destroyed last.
    Catalogue catalogue_;
    std::string controller_name_;
    Log log_;
    RateLimitedLog links_log_; ///< Log of all links: the loss of a server affects many models.
    std::unique_ptr<PieceExchange> exchange_; ///< Valid after create().
};

} // namespace tactus::dds
