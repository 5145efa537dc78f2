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

/// GUID of a DDS participant; on the wire, the identity of a controller.
using ParticipantId = std::array<std::uint8_t, 16>;

/// Reasons to refuse a sample of another program. Refused poses of known objects are counted in
/// PoseCounts instead.
enum class Refused : std::uint8_t
{
    identity,      ///< Sample of a server or controller other than its sender.
    object_number, ///< Object number of kMaxObjects or above.
    model_number,  ///< Model number of kMaxModels or above.
    object_name,
    object_material,
    object_pose, ///< Pose of a new object.
    not_served,  ///< Object of a model that its server does not serve.
    model_name,  ///< Invalid name of a model or of its scene.
    model_room,  ///< Offer of a model for which the catalogue has no room.
    controller,  ///< Invalid name of a controller, or too many controllers.
    request,     ///< Request for a piece that does not exist.
    /// Telemetry or refinement state with invalid names or numbers, or of too many controllers.
    telemetry,
    rate, ///< More pieces requested in a second than a server accepts from one process.
    edit, ///< Edit that can't be: wrong numbers, damaged bytes, or a model without edits.
    /// Request of an edit with impossible values, of a model without edits, or of a controller that
    /// may not edit.
    edit_request,
};
inline constexpr std::size_t kRefusedKinds = 15;

/// Refusals of one participant.
struct PeerRefusals
{
    /// GUID; zeros for all participants beyond the limit, and for writers that were already gone.
    ParticipantId id{};
    std::string name;                                  ///< Program, process and machine.
    std::array<std::uint64_t, kRefusedKinds> counts{}; ///< Counts in the order of Refused.
};

/// Names in the order of Refused, as keys of the report.
[[nodiscard]] const std::array<const char*, kRefusedKinds>& refused_names() noexcept;

/// Counts of refusals by participant and reason. Any thread.
class Refusals
{
public:
    /// Maximum number of entries in list(). The last one counts all further participants together.
    static constexpr std::size_t kMaxPeers = 64;

    /// Counts one refusal. `number` is that of the object or model, for the log line.
    void count(const ParticipantId& peer, Refused reason, std::uint32_t number = 0);

    /// Logs the first, tenth, hundredth, ... refusal of each participant and reason. Reasons
    /// not_served and controller are logged elsewhere.
    void report(RateLimitedLog& log,
                const std::function<std::string(const ParticipantId&)>& name_of);

    /// One entry for each participant, in the order of the first refusals.
    [[nodiscard]] std::vector<PeerRefusals> list() const;

private:
    struct Reason
    {
        std::uint32_t first{0}; ///< Number of the first refused object or model.
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
