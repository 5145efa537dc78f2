// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/cases.hpp"
#include "tests/bench/scenes.hpp"

namespace tactus::bench
{

/// Times of changes of about 1,000 faces from a server's call until a controller has all of their
/// edits, over loopback sockets, both stepped by this thread. A frame takes one of the edits.
void add_arrival_rows(CaseRows& rows, const Scene& scene, double period_s);

} // namespace tactus::bench
