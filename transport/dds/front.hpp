// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/topics.hpp"
#include "transport/front.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tactus::dds
{

/// The controller's side. One thread, the transport thread.
class FrontWriter
{
public:
    /// `domain` must outlive it; `controller_name` is valid (asserted).
    [[nodiscard]] static Result<std::unique_ptr<FrontWriter>, Refusal>
    create(const Domain& domain, std::string controller_name);

    /// Sends it to whoever looks; never waits. Models, objects, tools and pages are within their
    /// limits, objects name one of the models (asserted).
    void write(const Front& front);

    /// Whether anybody reads it.
    [[nodiscard]] bool is_watched() const { return is_matched(writer_); }

    /// How many were sent.
    [[nodiscard]] std::uint64_t sent() const noexcept { return sent_; }

private:
    FrontWriter(const ControllerId& controller, std::string controller_name);

    ControllerId controller_;
    std::string controller_name_;
    Endpoint writer_;
    std::uint64_t sent_{0};
};

/// A controller's newest front.
struct SeenFront
{
    ControllerId id{};
    std::uint64_t serial{0};
    Front front;
    std::uint64_t writer{0}; ///< Handle of the last sample's.
    bool is_disputed{false}; ///< Somebody said that it is gone, perhaps another program.
};

/// The viewer's side: the controllers on a domain, each at its newest. One thread.
class FrontReader
{
public:
    /// Controllers that one reader keeps; fronts of further ones are passed over.
    static constexpr std::size_t kMaxSeen = 64;

    /// `domain` must outlive it.
    [[nodiscard]] static Result<std::unique_ptr<FrontReader>, Refusal> create(const Domain& domain);

    /// Takes what has come, and forgets controllers that left or fell silent (500 ms). Bounded,
    /// never waits.
    void poll();

    /// In the order in which they were first seen. Until the next poll().
    [[nodiscard]] const std::vector<SeenFront>& fronts() const noexcept { return fronts_; }
    /// Fronts that contradict themselves, with numbers that can't be or of controllers beyond
    /// kMaxSeen.
    [[nodiscard]] std::uint64_t refused() const noexcept { return refused_; }

private:
    FrontReader(Participants& participants, Endpoint reader);

    Participants& participants_;
    Endpoint reader_;
    std::vector<SeenFront> fronts_;
    std::uint64_t refused_{0};
};

} // namespace tactus::dds
