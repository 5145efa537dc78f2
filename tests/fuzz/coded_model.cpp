// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/fuzz/coded_model.hpp"

#include "host_tools/shapes/shapes.hpp"
#include "tests/fuzz/law.hpp"
#include "tests/shared/test_model.hpp"
#include "transport/store/model_store.hpp"

namespace tactus::fuzz
{

namespace
{

CodedModel make_coded_model(Shape shape, const char* name)
{
    const auto mesh = make_shape(shape, 800);
    require(mesh.has_value(), "the generated shape exists");
    const auto store = ModelStore::open(test::test_model(name, mesh.value(), 60).path);
    require(store.has_value(), "the encoder's file opens");
    CodedModel model;
    const auto bytes = store.value().header_bytes();
    model.header_bytes.assign(bytes.begin(), bytes.end());
    model.header = ModelHeader::parse(model.header_bytes).value();
    require(store.value().read({ContentKind::base, 0}, model.base).has_value(), "it has a base");
    model.chunks.resize(model.header.counts().chunks());
    for (std::uint32_t chunk = 0; chunk < model.chunks.size(); ++chunk)
    {
        require(store.value().read({ContentKind::chunk, chunk}, model.chunks[chunk]).has_value(),
                "it has its chunks");
    }
    return model;
}

} // namespace

const CodedModel& coded_model(Lump lump)
{
    static const CodedModel closed = make_coded_model(Shape::bumpy_sphere, "closed");
    static const CodedModel open = make_coded_model(Shape::terrain, "open");
    return lump == Lump::closed ? closed : open;
}

} // namespace tactus::fuzz
