// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/served_model.hpp"

#include "transport/content_hash.hpp"

namespace tactus
{

Result<Done, SpmRefusal> load_base_mesh(std::span<const std::byte> bytes, const ModelHeader& header,
                                        const BaseMesh& mesh) noexcept
{
    if (content_hash(bytes) != header.fields().base_hash)
    {
        return SpmRefusal::wrong_checksum;
    }
    return parse_base_mesh(bytes, header, mesh);
}

Result<ModelHeader, SpmRefusal> parse_trusted_header(std::span<const std::byte> bytes) noexcept
{
    auto header = ModelHeader::parse(bytes);
    if (header && !has_sound_root_hash(bytes))
    {
        return SpmRefusal::wrong_checksum;
    }
    return header;
}

} // namespace tactus
