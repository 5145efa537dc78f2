// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::test
{

/// What is in a page or a drawing, by a reader of XML that shares nothing with the writer.
struct ReadMarkup
{
    std::vector<std::string> elements; ///< Names, in the order in which they open.
    std::vector<std::string> texts;    ///< Between tags, entities resolved; blank ones left out.

    [[nodiscard]] std::size_t count(std::string_view element) const;
    [[nodiscard]] bool has_text(std::string_view text) const;
};

/// Nothing when it is not well-formed: an element without its end, a bare '<', '&' or quote, an
/// attribute twice, a control character. Knows elements, attributes, text, a doctype, character
/// references and the five entities of XML.
[[nodiscard]] std::optional<ReadMarkup> read_markup(std::string_view markup);

} // namespace tactus::test
