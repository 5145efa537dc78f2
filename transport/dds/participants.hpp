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

/// By which a host is named on the wire: nobody else's samples carry it and pass.
[[nodiscard]] std::uint64_t host_epoch_of(const ParticipantId& participant) noexcept;

/// Who is on a domain, and whose a sample is. Its calls are safe from any thread, among them those
/// of Cyclone that deliver.
class Participants
{
public:
    /// `participant` is ours; the instance must outlive all readers below it.
    explicit Participants(std::int32_t participant);

    [[nodiscard]] const ParticipantId& own() const noexcept { return own_; }
    [[nodiscard]] std::uint64_t own_epoch() const noexcept { return own_epoch_; }

    /// Whose writer it is that a sample's publication_handle names; nothing when that is gone and
    /// was never seen. 0.1 us, the first time 10 us.
    [[nodiscard]] std::optional<ParticipantId> writer_of(std::uint64_t publication_handle);
    [[nodiscard]] bool is_host(std::uint64_t publication_handle, std::uint64_t host_epoch);

    /// Whether the writer that a sample's publication_handle names is there. 10 us.
    [[nodiscard]] bool is_writing(std::uint64_t publication_handle) const;
    /// Whether it is on the domain: it was heard within its lease. 10 us.
    [[nodiscard]] bool is_here(const ParticipantId& who) const;

    /// All but us that are: program, process and machine, in order; each once. Some 10 us each.
    [[nodiscard]] std::set<std::string> names() const;
    /// The program with its process and machine, as it tells them; with DDS Security also its
    /// certificate's name, which no other participant can use. 10 us.
    [[nodiscard]] std::string name_of(const ParticipantId& who) const;
    /// Whether it is called so: MACHINE, MACHINE:PROCESS or cert:HEX (is_valid_server). 10 us.
    [[nodiscard]] bool is_called(const ParticipantId& who, const std::string& server) const;
    /// With DDS Security 12 hexadecimal digits, the hash of the subject of its certificate: they
    /// begin its GUID, and the authentication plugin refuses a peer whose GUID begins with those of
    /// another subject. Empty without.
    [[nodiscard]] std::string certificate_of(const ParticipantId& who) const;

    /// Counts what the writer behind a publication_handle said under its participant; nothing when
    /// that is gone and was never seen.
    void refuse(std::uint64_t publication_handle, Refused reason, std::uint32_t number = 0);
    [[nodiscard]] Refusals& refusals() noexcept { return refusals_; }

    /// Names each participant that has come since the last call and has topics of another version
    /// of the protocol, once; each process that has 32 participants, 320, and so on; how many there
    /// are in all from 1,000 on; and what was refused, see Refusals::report(). Cheap without news.
    void report(RateLimitedLog& log);
    /// Participants on the domain, our own included, as of the last report().
    [[nodiscard]] std::size_t count() const noexcept { return here_.size(); }

private:
    /// Participants of one process.
    struct Crowd
    {
        std::size_t count{0};
        std::size_t told_at{kCrowd};
    };
    /// No honest process has so many, nor a domain.
    static constexpr std::size_t kCrowd = 32;
    static constexpr std::size_t kMultitude = 1'000;

    void report_other_versions(RateLimitedLog& log);
    void report_crowds(RateLimitedLog& log);
    void forget_participant(const ParticipantId& who);

    std::int32_t writers_; ///< Readers of what DDS itself publishes; they end with the participant.
    std::int32_t participants_;
    std::int32_t writer_news_; ///< The same, emptied by report().
    std::int32_t participant_news_;
    ParticipantId own_{};
    std::uint64_t own_epoch_;
    std::mutex mutex_;
    std::map<std::uint64_t, ParticipantId> known_;
    std::set<ParticipantId> reported_;
    std::map<std::string, Crowd> crowds_;       ///< By the name of the process.
    std::map<ParticipantId, std::string> here_; ///< And that of its process.
    std::size_t told_at_{kMultitude};
    Refusals refusals_;
};

} // namespace tactus::dds
