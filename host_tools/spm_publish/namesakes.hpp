// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"
#include "transport/dds/catalogue.hpp"
#include "transport/dds/dds_host.hpp"
#include "transport/log.hpp"

#include <chrono>
#include <cstdint>
#include <set>
#include <string>
#include <utility>

namespace tactus
{

/// Finds other servers on the domain that offer a model or a scene under one of our names, and logs
/// each: a controller takes the one that answers first.
class Namesakes
{
public:
    /// The host must outlive it and be able to find others: Party::both, or the user's
    /// configuration.
    [[nodiscard]] static Result<Namesakes, Refusal> create(const dds::DdsHost& host,
                                                           std::string scene, Log log);

    /// Searches if due. Call it often.
    void update();

private:
    using Clock = std::chrono::steady_clock;
    Namesakes(const dds::DdsHost& host, std::string scene, dds::Catalogue catalogue, Log log);

    void look_at(const dds::Catalogue::Offer& other, const std::string& name,
                 const std::string& what);

    const dds::DdsHost& host_;
    std::string scene_;
    dds::Catalogue catalogue_;
    RateLimitedLog log_;
    std::uint64_t seen_{0};
    Clock::time_point looked_{};
    /// Server and name of the logged offers.
    std::set<std::pair<std::uint64_t, std::string>> told_;
};

} // namespace tactus
