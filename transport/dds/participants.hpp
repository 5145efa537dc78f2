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

/// Epoch of a server: a hash of its participant. Samples with the epoch of another participant than
/// their writer's are dropped.
[[nodiscard]] std::uint64_t server_epoch_of(const ParticipantId& participant) noexcept;

/// Participants on a domain; finds the participant that wrote a sample. All calls are safe from any
/// thread, including Cyclone's receiving threads.
class Participants
{
public:
    /// `participant` is the DDS handle of this process's participant. This object must outlive all
    /// readers that were created with that handle.
    explicit Participants(std::int32_t participant);

    [[nodiscard]] const ParticipantId& own() const noexcept { return own_; }
    [[nodiscard]] std::uint64_t own_epoch() const noexcept { return own_epoch_; }

    /// Participant that owns the writer with this handle; none if it is gone and was never looked
    /// up. 0.1 us; 10 us the first time.
    [[nodiscard]] std::optional<ParticipantId> writer_of(std::uint64_t publication_handle);
    [[nodiscard]] bool is_server(std::uint64_t publication_handle, std::uint64_t server_epoch);

    /// True if the writer with this handle is present. 10 us.
    [[nodiscard]] bool is_writing(std::uint64_t publication_handle) const;
    /// True if the participant is present: its lease has not expired. 10 us.
    [[nodiscard]] bool is_resident(const ParticipantId& who) const;

    /// name_of() of all other participants, without duplicates. About 10 us for each.
    [[nodiscard]] std::set<std::string> names() const;
    /// Program, process and machine as reported by the participant. With DDS Security also its
    /// certificate_of(), which no other participant can claim. 10 us.
    [[nodiscard]] std::string name_of(const ParticipantId& who) const;
    /// True if `server`, a text that passes is_valid_server(), names the participant: cert:HEX,
    /// MACHINE or MACHINE:PROCESS, or with DDS Security the name of its certificate. 10 us.
    [[nodiscard]] bool is_called(const ParticipantId& who, const std::string& server) const;
    /// With DDS Security 12 hexadecimal digits, a hash of the subject of the certificate; otherwise
    /// empty. The hash begins the GUID; the authentication plugin refuses a GUID that begins with
    /// the hash of another subject.
    [[nodiscard]] std::string certificate_of(const ParticipantId& who) const;

    /// True if another participant with one of these certificates (certificate_of()) was present at
    /// the last report(). Its handshake need not have ended. The thread of report().
    [[nodiscard]] bool has_any_of(const std::set<std::string>& certificates) const;

    /// Counts a refusal for the participant that owns this writer. `number` is that of the refused
    /// object or model.
    void refuse(std::uint64_t publication_handle, Refused reason, std::uint32_t number = 0);
    [[nodiscard]] Refusals& refusals() noexcept { return refusals_; }

    /// Logs news since the last call: participants with another version of the protocol, once each;
    /// processes that reach 32 participants, then ten times as many, and so on; the number of all
    /// participants at 1,000, then at ten times as many; and refusals (Refusals::report()). Cheap
    /// without events.
    void report(RateLimitedLog& log);
    /// Number of participants on the domain, this one included, as of the last report().
    [[nodiscard]] std::size_t count() const noexcept { return here_.size(); }

private:
    /// Number of participants of one process, and the number at which the process is logged next.
    struct Crowd
    {
        std::size_t count{0};
        std::size_t told_at{kCrowd};
    };
    /// Numbers of participants of one process, and of a domain, at which they are logged; far above
    /// those of normal use.
    static constexpr std::size_t kCrowd = 32;
    static constexpr std::size_t kMultitude = 1'000;

    void report_other_versions(RateLimitedLog& log);
    void report_crowds(RateLimitedLog& log);
    [[nodiscard]] bool is_protected() const;
    void forget_participant(const ParticipantId& who);

    /// Readers of DDS's built-in topics of writers and participants; deleted with the participant.
    std::int32_t writers_;
    std::int32_t participants_;
    std::int32_t writer_news_; ///< Readers of the same topics for changes, emptied by report().
    std::int32_t participant_news_;
    ParticipantId own_{};
    std::uint64_t own_epoch_;
    std::mutex mutex_;
    std::map<std::uint64_t, ParticipantId> known_;
    std::set<ParticipantId> reported_;
    std::map<std::string, Crowd> crowds_; ///< Crowds by name of the process.
    /// Present participants, and the name of each one's process.
    std::map<ParticipantId, std::string> here_;
    std::size_t told_at_{kMultitude};
    Refusals refusals_;
};

} // namespace tactus::dds
