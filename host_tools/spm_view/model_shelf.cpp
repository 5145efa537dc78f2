// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_view/model_shelf.hpp"

#include "transport/store/model_store.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace tactus::view
{

namespace
{

class FileModel final : public KnownModel
{
public:
    explicit FileModel(ModelStore store)
        : store_(std::move(store)), name_(store_.path().filename().string())
    {
    }
    [[nodiscard]] const std::string& name() const noexcept override { return name_; }
    [[nodiscard]] const ContentHash& hash() const noexcept override { return store_.hash(); }
    [[nodiscard]] const ModelHeader& header() const noexcept override { return store_.header(); }
    [[nodiscard]] std::optional<Refusal> bring(std::span<const ContentKey> /*keys*/) override
    {
        return std::nullopt;
    }
    [[nodiscard]] Result<Done, Refusal> read(ContentKey key, std::vector<std::byte>& coded) override
    {
        const std::lock_guard lock(mutex_);
        return store_.read(key, coded);
    }

private:
    ModelStore store_;
    std::string name_;
    std::mutex mutex_; ///< For store_, which one thread at a time may use.
};

} // namespace

Result<std::unique_ptr<ModelShelf>, Refusal> ModelShelf::open(std::span<const std::string> files)
{
    auto shelf = std::make_unique<ModelShelf>();
    for (const std::string& file : files)
    {
        auto store = ModelStore::open(file);
        if (!store)
        {
            return store.error();
        }
        shelf->add(std::make_shared<FileModel>(std::move(store).value()));
    }
    return shelf;
}

void ModelShelf::add(std::shared_ptr<KnownModel> model)
{
    if (!has(model->hash()))
    {
        const std::lock_guard lock(mutex_);
        models_.push_back(std::move(model));
    }
}

void ModelShelf::announce(const ContentHash& hash)
{
    const std::lock_guard lock(mutex_);
    coming_.insert(hash);
}

std::vector<ModelShelf::Label> ModelShelf::labels() const
{
    const std::lock_guard lock(mutex_);
    std::vector<Label> labels;
    for (const auto& model : models_)
    {
        labels.push_back({model->hash(), model->name(), model->header().fields().source_faces});
    }
    return labels;
}

bool ModelShelf::is_coming(const ContentHash& hash) const
{
    const std::lock_guard lock(mutex_);
    return coming_.contains(hash);
}

std::shared_ptr<KnownModel> ModelShelf::find(const ContentHash& hash) const
{
    const std::lock_guard lock(mutex_);
    const auto found =
        std::ranges::find_if(models_, [&](const auto& model) { return model->hash() == hash; });
    return found == models_.end() ? nullptr : *found;
}

} // namespace tactus::view
