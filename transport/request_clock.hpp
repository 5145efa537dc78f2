// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>

namespace tactus
{

/// Waiting time of one request for a piece. The request is overdue when it is repeated after a
/// second in which a server was present and no answer came.
class RequestClock
{
public:
    static constexpr std::int64_t kOverdue_ns = 1'000'000'000;

    RequestClock() = default;
    explicit RequestClock(std::int64_t now_ns)
        : opened_ns_(now_ns), requested_ns_(now_ns), hosted_ns_(now_ns)
    {
    }

    /// Records a repeated request; true once, when the request becomes overdue. After a pause of
    /// more than `forgotten_ns` the second starts again.
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
    /// Records that no server was present.
    void wait_for_host(std::int64_t now_ns) { hosted_ns_ = now_ns; }

    [[nodiscard]] bool is_overdue() const { return is_overdue_; }
    /// True if the request is overdue and was repeated within the last `forgotten_ns`.
    [[nodiscard]] bool is_missed(std::int64_t now_ns, std::int64_t forgotten_ns) const
    {
        return is_overdue_ && now_ns - requested_ns_ <= forgotten_ns;
    }
    [[nodiscard]] std::int64_t waited_ns(std::int64_t now_ns) const { return now_ns - opened_ns_; }

private:
    std::int64_t opened_ns_{0};
    std::int64_t requested_ns_{0}; ///< Time of the last request.
    /// Start of the time in which the piece was wanted and a server was present.
    std::int64_t hosted_ns_{0};
    bool is_overdue_{false};
};

} // namespace tactus
