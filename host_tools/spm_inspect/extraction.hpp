// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/decoded_model.hpp"
#include "host_tools/encode/extract.hpp"

#include <optional>
#include <string>

namespace tactus
{

class CommandLine;

/// --extract and the options that say what and where to.
class Extractor
{
public:
    /// The extractor must outlive the parsing.
    void declare_options(CommandLine& line);

    /// Why the options make no sense together; nothing when they do.
    [[nodiscard]] std::optional<std::string> wrong_usage() const;

    [[nodiscard]] bool is_wanted() const { return wanted_; }

    /// Writes the mesh of a model without faults and says on stderr what it is. Returns why it
    /// could not be written.
    [[nodiscard]] std::optional<std::string> run(const DecodedModel& model) const;

private:
    bool wanted_{false};
    ExtractRequest request_; ///< But the zone.
    std::string region_;     ///< That, as text; empty: none.
    std::string output_;
};

} // namespace tactus
