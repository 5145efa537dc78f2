// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>

namespace tactus
{

/// Measures the wait of one request for a piece. The request becomes overdue at its first
/// repetition after a second in which a server was present and the piece did not arrive. Times are
/// in ns.
class RequestClock
{
public:
    static constexpr std::int64_t kOverdue_ns = 1'000'000'000;

    RequestClock() = default;
    explicit RequestClock(std::int64_t now_ns)
        : opened_ns_(now_ns), requested_ns_(now_ns), hosted_ns_(now_ns)
    {
    }

    /// Records a repetition; true if the request becomes overdue by it, once. After a pause of more
    /// than `forgotten_ns` since the last repetition the second begins again.
    [[nodiscard]] bool request(std::int64_t now_ns, std::int64_t forgotten_ns)
    {
        if (now_ns - requested_ns_ > forgotten_ns)
        {
            hosted_ns_ = now_ns;
        }
        requested_ns_ = now_ns;
        const bool runs_out = !is_overdue_ && now_ns - hosted_ns_ >= kOverdue_ns;
        is_overdue_ = is_overdue_ || runs_out;
        return runs_out;
    }
    /// Records that no server is present: the second begins again.
    void wait_for_server(std::int64_t now_ns) { hosted_ns_ = now_ns; }

    [[nodiscard]] bool is_overdue() const { return is_overdue_; }
    /// True if the request is overdue and was repeated within the last `forgotten_ns`, so still
    /// wanted.
    [[nodiscard]] bool is_missed(std::int64_t now_ns, std::int64_t forgotten_ns) const
    {
        return is_overdue_ && now_ns - requested_ns_ <= forgotten_ns;
    }
    [[nodiscard]] std::int64_t waited_ns(std::int64_t now_ns) const { return now_ns - opened_ns_; }

private:
    std::int64_t opened_ns_{0};
    std::int64_t requested_ns_{0}; ///< Time of the first request or of the last repetition.
    /// Start of the second after which a repetition makes the request overdue.
    std::int64_t hosted_ns_{0};
    bool is_overdue_{false};
};

} // namespace tactus
