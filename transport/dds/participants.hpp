// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/dds/refusals.hpp"
#include "transport/log.hpp"

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>

namespace tactus::dds
{

using ControllerId = ParticipantId;

/// Name of a server on the wire, from its participant: samples of other participants that carry it
/// are dropped.
[[nodiscard]] std::uint64_t host_epoch_of(const ParticipantId& participant) noexcept;

/// Participants on a domain, and the participant of each sample. All calls are safe from any
/// thread, including those of Cyclone that deliver.
class Participants
{
public:
    /// `participant` is this process's own; the instance must outlive all readers below it.
    explicit Participants(std::int32_t participant);

    [[nodiscard]] const ParticipantId& own() const noexcept { return own_; }
    [[nodiscard]] std::uint64_t own_epoch() const noexcept { return own_epoch_; }

    /// Participant whose writer a sample's publication_handle names; none if it is gone and was
    /// never seen. 0.1 us, the first time 10 us.
    [[nodiscard]] std::optional<ParticipantId> writer_of(std::uint64_t publication_handle);
    [[nodiscard]] bool is_host(std::uint64_t publication_handle, std::uint64_t host_epoch);

    /// True if the writer that a sample's publication_handle names is present. 10 us.
    [[nodiscard]] bool is_writing(std::uint64_t publication_handle) const;
    /// True if the participant is on the domain: heard within its lease. 10 us.
    [[nodiscard]] bool is_resident(const ParticipantId& who) const;

    /// Program, process and machine of all other participants, sorted and unique. About 10 us each.
    [[nodiscard]] std::set<std::string> names() const;
    /// Program, process and machine as the participant reports them; with DDS Security also the
    /// name of its certificate, which no other participant can use. 10 us.
    [[nodiscard]] std::string name_of(const ParticipantId& who) const;
    /// True if `server` names the participant: MACHINE, MACHINE:PROCESS or cert:HEX
    /// (is_valid_server). 10 us.
    [[nodiscard]] bool is_called(const ParticipantId& who, const std::string& server) const;
    /// 12 hexadecimal digits with DDS Security: the hash of the subject of its certificate. They
    /// begin its GUID, and the authentication plugin refuses a peer whose GUID begins with those of
    /// another subject. Empty without DDS Security.
    [[nodiscard]] std::string certificate_of(const ParticipantId& who) const;

    /// Counts a refusal under the participant of a publication_handle; no effect if it is gone and
    /// was never seen.
    void refuse(std::uint64_t publication_handle, Refused reason, std::uint32_t number = 0);
    [[nodiscard]] Refusals& refusals() noexcept { return refusals_; }

    /// Logs each participant that appeared since the last call and has topics of another version of
    /// the protocol, once; each process with 32 participants, 320, and so on; the number of all
    /// participants from 1,000 on; and refusals, see Refusals::report(). Cheap without events.
    void report(RateLimitedLog& log);
    /// Number of participants on the domain, this one included, as of the last report().
    [[nodiscard]] std::size_t count() const noexcept { return here_.size(); }

private:
    /// Participants of one process.
    struct Crowd
    {
        std::size_t count{0};
        std::size_t told_at{kCrowd};
    };
    /// Limits above which a process, and a domain, are reported: no honest one has so many
    /// participants.
    static constexpr std::size_t kCrowd = 32;
    static constexpr std::size_t kMultitude = 1'000;

    void report_other_versions(RateLimitedLog& log);
    void report_crowds(RateLimitedLog& log);
    void forget_participant(const ParticipantId& who);

    std::int32_t writers_; ///< Readers of DDS's built-in topics; they end with the participant.
    std::int32_t participants_;
    std::int32_t writer_news_; ///< Readers of the same topics, emptied by report().
    std::int32_t participant_news_;
    ParticipantId own_{};
    std::uint64_t own_epoch_;
    std::mutex mutex_;
    std::map<std::uint64_t, ParticipantId> known_;
    std::set<ParticipantId> reported_;
    std::map<std::string, Crowd> crowds_;       ///< Crowds by name of the process.
    std::map<ParticipantId, std::string> here_; ///< Participants and the names of their processes.
    std::size_t told_at_{kMultitude};
    Refusals refusals_;
};

} // namespace tactus::dds
