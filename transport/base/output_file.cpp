// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/base/output_file.hpp"

#include "transport/base/atomic_file.hpp"

#include <cstddef>
#include <span>

namespace tactus
{

std::optional<Refusal> probe_output(const std::string& path)
{
    return path.empty() ? std::nullopt : AtomicFile::probe(path);
}

std::optional<Refusal> write_text(const std::string& text, const std::string& path)
{
    auto file = AtomicFile::create(path);
    if (!file)
    {
        return file.error();
    }
    auto done = file.value().write(std::as_bytes(std::span(text)));
    done = done ? file.value().commit() : done;
    return done ? std::nullopt : std::optional(done.error());
}

} // namespace tactus
