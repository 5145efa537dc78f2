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

/// Option --extract and the options for its content and output.
class Extractor
{
public:
    /// Declares the options. The extractor must outlive the parsing.
    void declare_options(CommandLine& line);

    /// Fault of a combination of the options, if any.
    [[nodiscard]] std::optional<std::string> wrong_usage() const;

    [[nodiscard]] bool is_wanted() const { return wanted_; }

    /// Writes the mesh of a model without faults and describes it on stderr. Returns the reason if
    /// it could not be written.
    [[nodiscard]] std::optional<std::string> run(const DecodedModel& model) const;

private:
    bool wanted_{false};
    ExtractRequest request_; ///< Request; its zone is not set, see `region_`.
    std::string region_;     ///< Zone as text; empty if there is none.
    std::string output_;
};

} // namespace tactus
