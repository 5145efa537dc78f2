// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"
#include "transport/dds/catalogue.hpp"
#include "transport/dds/dds_server.hpp"
#include "transport/log.hpp"

#include <chrono>
#include <cstdint>
#include <set>
#include <string>
#include <utility>

namespace tactus
{

/// Finds other servers on the domain that offer a model or scene under a name of this server, and
/// logs each. A controller would take the server that answers first.
class Namesakes
{
public:
    /// `server` must outlive the result, and must be able to find other servers: Party::both, or a
    /// configuration of the user.
    [[nodiscard]] static Result<Namesakes, Refusal> create(const dds::DdsServer& server,
                                                           std::string scene, Log log);

    /// Searches if 100 ms have passed. Call it often.
    void update();

private:
    using Clock = std::chrono::steady_clock;
    Namesakes(const dds::DdsServer& server, std::string scene, dds::Catalogue catalogue, Log log);

    void look_at(const dds::Catalogue::Offer& other, const std::string& name,
                 const std::string& what);

    const dds::DdsServer& server_;
    std::string scene_;
    dds::Catalogue catalogue_;
    RateLimitedLog log_;
    std::uint64_t seen_{0};
    Clock::time_point looked_{};
    /// Epoch of the server and name of each offer that was logged.
    std::set<std::pair<std::uint64_t, std::string>> told_;
};

} // namespace tactus
