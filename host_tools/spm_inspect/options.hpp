// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/decoded_model.hpp"
#include "host_tools/encode/extract.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/math/vec3.hpp"
#include "transport/base/refusal.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

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

/// Reads points as text, x y z in metres on each line; blank lines and those that begin with # are
/// ignored. A refusal names the line.
[[nodiscard]] Result<std::vector<Vec3>, Refusal> parse_points(std::string_view text);

/// Prints the distances of the points of a file to a model's surface, one line each in their order,
/// or all as one JSON object. Returns the reason if it fails.
[[nodiscard]] std::optional<std::string>
print_distances(const std::string& model_file, const std::string& point_file, bool as_json);

} // namespace tactus

namespace tactus::spm_inspect
{

/// Options of the command line; checked, in SI units.
struct Options
{
    std::string file;
    bool json{false};
    bool regions{false};
    bool records{false};
    std::string points; ///< File of points for distances; empty if there is none.
    Extractor extractor;
};

/// Reads the command line. Returns the exit code instead if the program should leave: after --help,
/// --version, or wrong usage, which gets one line on stderr.
[[nodiscard]] std::variant<Options, int> parse_options(CommandLine& line, int argc, char** argv);

} // namespace tactus::spm_inspect
