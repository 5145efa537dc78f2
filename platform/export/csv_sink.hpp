// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/export/field_sink.hpp"

#include <string>

namespace tactus
{

/// Makes one line of comma-separated values (RFC 4180): the columns' names, their values, or empty
/// cells. A vector has columns NAME.x, .y, .z, a rotation .w, too. A flag is 1 or 0; words are
/// separated by blanks; an unknown value is an empty cell, a number that is not finite inf, -inf or
/// nan.
class CsvSink final : public FieldSink
{
public:
    enum class Cells : std::uint8_t
    {
        names,
        values,
        empty,
    };

    /// Selects the kind of the following cells. `prefix` goes before each name.
    void begin(Cells cells, std::string prefix = "");

    void number(const char* name, const std::optional<double>& value) override;
    void integer(const char* name, const std::optional<std::int64_t>& value) override;
    void flag(const char* name, bool value) override;
    void text(const char* name, std::string_view value) override;
    void words(const char* name, const std::vector<std::string>& value) override;
    void vector(const char* name, const std::optional<Vec3>& value) override;
    void rotation(const char* name, const std::optional<Eigen::Quaterniond>& value) override;

    /// Returns the line, ended by CR LF, and empties the sink.
    [[nodiscard]] std::string take();

private:
    void cell(const char* name, const char* suffix, std::string_view value);

    Cells cells_{Cells::values};
    std::string prefix_;
    std::string line_;
    bool has_cells_{false};
};

} // namespace tactus
