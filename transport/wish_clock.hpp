// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>

namespace tactus
{

/// How long a wish has waited for its piece. It is overdue when it is made again after a second in
/// which there was a host and nothing came.
class WishClock
{
public:
    static constexpr std::int64_t kOverdue_ns = 1'000'000'000;

    WishClock() = default;
    explicit WishClock(std::int64_t now_ns)
        : opened_ns_(now_ns), wished_ns_(now_ns), hosted_ns_(now_ns)
    {
    }

    /// It was wished for once more; true once, when it is overdue by that. A pause of more than
    /// `forgotten_ns` means that nobody wanted it meanwhile.
    [[nodiscard]] bool wish(std::int64_t now_ns, std::int64_t forgotten_ns)
    {
        if (now_ns - wished_ns_ > forgotten_ns)
        {
            hosted_ns_ = now_ns;
        }
        wished_ns_ = now_ns;
        const bool runs_out = !is_overdue_ && now_ns - hosted_ns_ >= kOverdue_ns;
        is_overdue_ = is_overdue_ || runs_out;
        return runs_out;
    }
    /// Nobody has been there who could serve it.
    void wait_for_host(std::int64_t now_ns) { hosted_ns_ = now_ns; }

    [[nodiscard]] bool is_overdue() const { return is_overdue_; }
    /// Overdue, and wished for within the last `forgotten_ns`.
    [[nodiscard]] bool is_missed(std::int64_t now_ns, std::int64_t forgotten_ns) const
    {
        return is_overdue_ && now_ns - wished_ns_ <= forgotten_ns;
    }
    [[nodiscard]] std::int64_t waited_ns(std::int64_t now_ns) const { return now_ns - opened_ns_; }

private:
    std::int64_t opened_ns_{0};
    std::int64_t wished_ns_{0}; ///< The last time.
    std::int64_t hosted_ns_{0}; ///< Since when it has been wished for and there is a host.
    bool is_overdue_{false};
};

} // namespace tactus
