// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/base/atomic_file.hpp"
#include "platform/base/refusal.hpp"
#include "tests/bench/bench_report.hpp"

#include <optional>
#include <string>

namespace tactus::bench
{

/// The files that a run leaves; an empty name is none.
struct OutputPaths
{
    std::string json;
    std::string csv;
    std::string html;

    /// Why they can't all be written; nothing when they can.
    [[nodiscard]] std::optional<std::string> wrong_usage() const;
};

/// Made before the run, so that an hour of it is not lost to a name that can't be written.
class OutputFiles
{
public:
    [[nodiscard]] static Result<OutputFiles, Refusal> create(const OutputPaths& paths);

    /// Once, at the end; files without it don't appear.
    [[nodiscard]] Result<Done, Refusal> write(const Results& results, const RunFacts& facts);

private:
    OutputFiles() = default;

    std::optional<AtomicFile> json_;
    std::optional<AtomicFile> csv_;
    std::optional<AtomicFile> html_;
};

} // namespace tactus::bench
