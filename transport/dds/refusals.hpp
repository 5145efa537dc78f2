// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/log.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace tactus::dds
{

/// A participant's GUID: names a controller on the wire.
using ParticipantId = std::array<std::uint8_t, 16>;

/// Why something that another program said on the domain changed nothing here. Poses that an object
/// moves to are counted beside the object (PoseRefusal).
enum class Refused : std::uint8_t
{
    identity,      ///< A sample names another host or controller than it comes from.
    object_number, ///< An object from kMaxObjects on,
    model_number,  ///< or a model from kMaxModels on.
    object_name,
    object_material,
    object_pose, ///< Where it comes.
    not_served,  ///< An object of a model that its host doesn't serve.
    model_name,  ///< Or that of its scene.
    model_room,  ///< More models than are remembered.
    controller,  ///< Its name is none, or there are too many.
    wish,        ///< For a piece that there isn't.
    telemetry,   ///< Or a front: names or numbers that are none, or too many to watch.
    rate,        ///< More pieces asked for in a second than a host takes in.
};
inline constexpr std::size_t kRefusedKinds = 13;

/// What of one participant was refused.
struct PeerRefusals
{
    ParticipantId id{}; ///< Zeros: of many, or of writers that were gone when they were heard.
    std::string name;   ///< The program with its process and machine.
    std::array<std::uint64_t, kRefusedKinds> counts{}; ///< In the order of Refused.
};

/// In the order of Refused: keys of the report.
[[nodiscard]] const std::array<const char*, kRefusedKinds>& refused_names() noexcept;

/// What was refused, of whom and why. Any thread.
class Refusals
{
public:
    /// Participants that are told apart; those that come later are counted together.
    static constexpr std::size_t kMaxPeers = 64;

    /// `number` is that of the object or model, for the line.
    void count(const ParticipantId& peer, Refused reason, std::uint32_t number = 0);

    /// Writes a line for each participant and reason when the first one was refused, the tenth, the
    /// hundredth, and so on. What is told of where it is refused has none here.
    void report(RateLimitedLog& log,
                const std::function<std::string(const ParticipantId&)>& name_of);

    /// In the order in which they were first refused something.
    [[nodiscard]] std::vector<PeerRefusals> list() const;

private:
    struct Reason
    {
        std::uint32_t first{0}; ///< Number of the first object or model.
        std::uint64_t told_at{1};
    };
    struct Peer
    {
        PeerRefusals refused;
        std::array<Reason, kRefusedKinds> reasons{};
    };

    [[nodiscard]] std::vector<std::string> take_lines(std::span<const std::string> names);

    mutable std::mutex mutex_;
    std::vector<Peer> peers_;
    std::atomic<bool> has_news_{false};
};

} // namespace tactus::dds
