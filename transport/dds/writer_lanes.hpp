// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/dds/topics.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace tactus::dds
{

/// Writers of one topic in one partition that take turns. Reliable delivery keeps the order of each
/// writer, so a datagram that is lost holds back what its own writer sent after it, not the rest.
/// What goes through lanes may come in another order.
class WriterLanes
{
public:
    [[nodiscard]] static Result<WriterLanes, DdsError> create(const Domain& domain, Topic topic,
                                                              const std::string& partition);

    /// Whether any of them has a reader.
    [[nodiscard]] bool is_matched() const;
    /// Writes by the next one that has a reader, or, when none has, by any: to nobody. False when
    /// the sample is lost.
    bool write(const void* sample);

    static constexpr std::size_t kLanes = 4;

private:
    std::array<Endpoint, kLanes> writers_;
    std::size_t turn_{0};
};

} // namespace tactus::dds
