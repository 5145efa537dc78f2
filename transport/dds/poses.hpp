// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/base/refusal.hpp"
#include "transport/dds/catalogue.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/topics.hpp"
#include "transport/model_identity.hpp"
#include "transport/pose.hpp"

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

struct tactus_v1_ObjectPose; // idlc's type of a sample.

namespace tactus::dds
{

/// A pose at rest is sent again after this. Late joiners learn it so, and a controller knows that
/// it still holds: it takes poses for stale after 100 ms, four lost ones in a row do no harm.
inline constexpr std::chrono::milliseconds kPoseRepeat{20};

/// The host's side of moving objects, for any program that moves them: the one that serves their
/// models or another one, which finds the epoch in a Catalogue::Offer. One thread.
class PosePublisher
{
public:
    /// `domain` must outlive it; `objects` are models of the host with that epoch.
    [[nodiscard]] static Result<std::unique_ptr<PosePublisher>, Refusal>
    create(const Domain& domain, std::uint64_t host_epoch, std::vector<ModelIdentity> objects);

    /// Sends the pose of the object with that index at once; from now on the object is followed.
    /// Refused, with nothing sent, when the numbers aren't a pose. Never waits.
    [[nodiscard]] Result<Done, PoseRefusal> move(std::size_t object, const Pose& pose);

    /// Sends again what has rested for kPoseRepeat; call it at least that often.
    void repeat();

    [[nodiscard]] const std::vector<ModelIdentity>& objects() const noexcept { return objects_; }

private:
    using Clock = std::chrono::steady_clock;
    struct State
    {
        std::size_t writer{0};
        bool is_moved{false};
        Pose pose;
        Clock::time_point last_sent{};
    };

    PosePublisher(std::uint64_t host_epoch, std::vector<ModelIdentity> objects);

    [[nodiscard]] Result<Done, Refusal> open_writers(const Domain& domain);
    void send(std::size_t object);

    std::uint64_t host_epoch_;
    std::vector<ModelIdentity> objects_;
    std::vector<State> states_;     ///< One an object.
    std::vector<Endpoint> writers_; ///< One a model.
    std::uint64_t serial_;
};

/// A pose that has passed every check.
struct PoseNews
{
    std::size_t object{0};
    Pose pose; ///< Its rotation has length 1.
    std::int64_t host_time_ns{0};
};

/// What has come for one object.
struct PoseCounts
{
    std::uint64_t accepted{0};
    std::array<std::uint64_t, kPoseRefusals> refused{}; ///< In the order of PoseRefusal.

    [[nodiscard]] std::uint64_t refused_in_all() const noexcept;
};

/// The controller's side: the newest poses of its objects, from the hosts that serve their models.
/// What is older than the last one, or no pose, is counted and passed over. One thread, that which
/// refreshes the catalogue.
class PoseReader
{
public:
    /// `domain` and `catalogue` must outlive it.
    [[nodiscard]] static Result<std::unique_ptr<PoseReader>, Refusal>
    create(const Domain& domain, const Catalogue& catalogue, std::vector<ModelIdentity> objects);

    /// Hands over what has come: one pose at most of each object and host. Bounded, never waits.
    void poll(const std::function<void(const PoseNews&)>& take);

    /// One an object.
    [[nodiscard]] const std::vector<PoseCounts>& counts() const noexcept { return counts_; }

private:
    /// Last accepted of one object.
    struct Last
    {
        std::uint64_t host_epoch{0};
        std::uint64_t serial{0};
    };

    PoseReader(const Catalogue& catalogue, std::vector<ModelIdentity> objects);

    void take_sample(const tactus_v1_ObjectPose& sample,
                     const std::function<void(const PoseNews&)>& take);
    [[nodiscard]] Result<Pose, PoseRefusal> judge(const tactus_v1_ObjectPose& sample,
                                                  std::size_t object) const;

    const Catalogue& catalogue_;
    std::vector<ModelIdentity> objects_;
    std::vector<Last> last_;
    std::vector<PoseCounts> counts_;
    Endpoint reader_;
};

} // namespace tactus::dds
