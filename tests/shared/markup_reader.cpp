// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/markup_reader.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace tactus::test
{

namespace
{

class Reader
{
public:
    explicit Reader(std::string_view markup) : rest_(markup) {}

    std::optional<ReadMarkup> read()
    {
        if (rest_.starts_with("<!DOCTYPE html>\n"))
        {
            rest_.remove_prefix(16);
        }
        bool is_sound = true;
        while (is_sound && !rest_.empty())
        {
            is_sound = rest_[0] == '<' ? read_tag() : read_text();
        }
        const bool is_whole = is_sound && open_.empty() && !found_.elements.empty();
        return is_whole ? std::optional(std::move(found_)) : std::nullopt;
    }

private:
    static bool is_name(char c)
    {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == ':';
    }

    std::string name()
    {
        const auto end = std::ranges::find_if_not(rest_, is_name);
        const std::string word(rest_.begin(), end);
        rest_.remove_prefix(word.size());
        return word;
    }

    bool take(std::string_view text)
    {
        const bool is_there = rest_.starts_with(text);
        rest_.remove_prefix(is_there ? text.size() : 0);
        return is_there;
    }

    bool read_tag()
    {
        take("<");
        if (take("/"))
        {
            const std::string word = name();
            const bool is_own = !open_.empty() && open_.back() == word && take(">");
            open_.resize(open_.size() - (is_own ? 1 : 0));
            return is_own;
        }
        const std::string word = name();
        if (word.empty() || (open_.empty() && !found_.elements.empty()))
        {
            return false;
        }
        found_.elements.push_back(word);
        std::vector<std::string> attributes;
        while (take(" "))
        {
            const std::string attribute = name();
            if (attribute.empty() || std::ranges::count(attributes, attribute) > 0 || !take("=\""))
            {
                return false;
            }
            attributes.push_back(attribute);
            const std::size_t end = rest_.find('"');
            if (end == std::string_view::npos || !resolved(rest_.substr(0, end)))
            {
                return false;
            }
            rest_.remove_prefix(end + 1);
        }
        if (take("/>"))
        {
            return true;
        }
        open_.push_back(word);
        return take(">");
    }

    bool read_text()
    {
        const std::string_view raw = rest_.substr(0, rest_.find('<'));
        rest_.remove_prefix(raw.size());
        const bool is_blank = raw.find_first_not_of(" \n") == std::string_view::npos;
        const std::optional<std::string> text = resolved(raw);
        if (!text || (open_.empty() && !is_blank))
        {
            return false;
        }
        if (!is_blank)
        {
            found_.texts.push_back(*text);
        }
        return true;
    }

    /// What the characters stand for; nothing when one must not be there.
    static std::optional<std::string> resolved(std::string_view raw)
    {
        constexpr std::array<std::pair<std::string_view, char>, 5> kEntities{
            {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&#39;", '\''}}};
        std::string text;
        while (!raw.empty())
        {
            const auto entity = std::ranges::find_if(kEntities, [raw](const auto& one)
                                                     { return raw.starts_with(one.first); });
            const char c = raw[0];
            const bool is_control = static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t';
            if (entity == kEntities.end() && (c == '&' || c == '<' || is_control))
            {
                return std::nullopt;
            }
            text += entity == kEntities.end() ? c : entity->second;
            raw.remove_prefix(entity == kEntities.end() ? 1 : entity->first.size());
        }
        return text;
    }

    std::string_view rest_;
    std::vector<std::string> open_;
    ReadMarkup found_;
};

} // namespace

std::size_t ReadMarkup::count(std::string_view element) const
{
    return static_cast<std::size_t>(std::ranges::count(elements, element));
}

bool ReadMarkup::has_text(std::string_view text) const
{
    return std::ranges::find(texts, text) != texts.end();
}

std::optional<ReadMarkup> read_markup(std::string_view markup)
{
    return Reader(markup).read();
}

} // namespace tactus::test
