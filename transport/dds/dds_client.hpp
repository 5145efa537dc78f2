// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/base/refusal.hpp"
#include "transport/dds/catalogue.hpp"
#include "transport/dds/dds_link.hpp"
#include "transport/dds/domain.hpp"
#include "transport/log.hpp"
#include "transport/model_name.hpp"
#include "transport/served_model.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace tactus::dds
{

/// A controller on a DDS domain: finds models and makes links to them. One thread, the transport
/// thread, uses it and its links.
class DdsClient
{
public:
    /// `controller_name` is shown by hosts; a valid name. Join from an ordinary thread, see Domain.
    [[nodiscard]] static Result<std::unique_ptr<DdsClient>, Refusal>
    create(std::uint32_t domain, std::string controller_name, Log log);

    /// Waits until the model is published, its header and base mesh came and its host answers;
    /// everything is verified. The only call here that waits: at most `timeout`, or until `go_on`
    /// (asked every few milliseconds) returns false. The client must outlive the model's link.
    [[nodiscard]] Result<ServedModel, Refusal> find(const ModelSelector& selector,
                                                    std::chrono::milliseconds timeout,
                                                    const std::function<bool()>& go_on = {});

    [[nodiscard]] const Catalogue& catalogue() const noexcept { return catalogue_; }
    /// For further topics of the same controller; lives as long as the client.
    [[nodiscard]] const Domain& domain() const noexcept { return domain_; }
    [[nodiscard]] const std::string& controller_name() const noexcept { return controller_name_; }

private:
    struct Wait;

    DdsClient(Domain domain, Catalogue catalogue, std::string controller_name, Log log);

    [[nodiscard]] Result<Catalogue::Offer, Refusal> wait_for_offer(const ModelSelector& selector,
                                                                   const Wait& wait);
    [[nodiscard]] Result<Done, Refusal> wait_for_start(const Catalogue::Offer& offer,
                                                       const Wait& wait, ServedModel& model);
    [[nodiscard]] Result<Done, Refusal> wait_for_link(DdsLink& link, const Wait& wait,
                                                      const std::string& name);

    Domain domain_; ///< First, so that it is left last.
    Catalogue catalogue_;
    std::string controller_name_;
    Log log_;
};

} // namespace tactus::dds
