// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/diagnose/doctor/finding.hpp"
#include "transport/dds/domain.hpp"

#include <chrono>

namespace tactus::hrtc
{

/// Joins a DDS domain, 0 to 232, as a controller and listens for `wait`. Reports the participants
/// and published models. Good if there are models, critical if the domain can't be joined, else
/// advice. Ordinary thread; waits.
[[nodiscard]] doctor::Finding check_domain(const dds::DomainChoice& choice,
                                           std::chrono::milliseconds wait);

} // namespace tactus::hrtc
