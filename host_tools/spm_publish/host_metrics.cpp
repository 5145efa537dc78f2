// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_publish/host_metrics.hpp"

#include "host_tools/web/prometheus_text.hpp"
#include "transport/content_hash.hpp"

#include <cstdint>
#include <vector>

namespace tactus
{

namespace
{

constexpr std::chrono::seconds kPeriod{1};

void tell_models(web::PrometheusText& text, const dds::DdsHost& host)
{
    const auto tell = [&](const char* name, const char* help, auto value)
    {
        text.family(name, "gauge", help);
        for (const dds::ModelPieces& model : host.models())
        {
            text.sample({{"model", model.model().name}, {"hash", hash_text(model.store().hash())}},
                        static_cast<double>(value(model.store().header().fields())));
        }
    };
    tell("tactus_model_faces", "Faces of the source of a model that is served.",
         [](const HeaderFields& fields) { return fields.source_faces; });
    tell("tactus_model_bytes", "Bytes of its file.",
         [](const HeaderFields& fields) { return fields.file_bytes; });
}

void tell_subscribers(web::PrometheusText& text, const dds::DdsHost& host)
{
    const std::vector<dds::DdsHost::Subscriber> subscribers = host.subscribers();
    const auto tell = [&](const char* name, const char* help, auto value)
    {
        text.family(name, "counter", help);
        for (const dds::DdsHost::Subscriber& subscriber : subscribers)
        {
            text.sample({{"subscriber", subscriber.controller}},
                        static_cast<double>(value(subscriber)));
        }
    };
    tell("tactus_subscriber_pieces_sent_total", "Pieces sent to a controller that is here.",
         [](const auto& subscriber) { return subscriber.pieces_sent; });
    tell("tactus_subscriber_bytes_sent_total", "Payload sent to it.",
         [](const auto& subscriber) { return subscriber.bytes_sent; });
}

} // namespace

std::string host_metrics(dds::DdsHost& host, const dds::TelemetryReader& controllers)
{
    web::PrometheusText text;
    const dds::DdsHost::Counters counters = host.counters();
    const auto tell =
        [&text](const char* name, const char* type, const char* help, std::uint64_t value)
    {
        text.family(name, type, help);
        text.sample({}, static_cast<double>(value));
    };
    tell("tactus_pieces_sent_total", "counter", "Pieces of models sent to controllers.",
         counters.pieces_sent);
    tell("tactus_bytes_sent_total", "counter", "Payload sent to controllers.", counters.bytes_sent);
    tell("tactus_requests_total", "counter", "Requests of controllers.", counters.requests);
    tell("tactus_requests_refused_total", "counter", "Requests that were refused.",
         counters.requests_refused);
    tell("tactus_writers_renewed_total", "counter",
         "Times that writers were replaced for controllers that they did not reach.",
         counters.renewed);
    tell("tactus_participants", "gauge", "DDS participants on the domain.",
         host.domain().participants().count());
    tell("tactus_subscribers", "gauge", "Controllers that this host serves.",
         host.subscribers().size());
    tell("tactus_objects_shown", "gauge", "Objects that this host shows.",
         host.objects().objects());
    tell_models(text, host);
    tell_subscribers(text, host);
    std::vector<const dds::WatchedController*> watched;
    for (const dds::WatchedController& controller : controllers.controllers())
    {
        watched.push_back(&controller);
    }
    web::tell_controllers(text, watched);
    return text.text();
}

void HostMetrics::update(dds::DdsHost& host, const dds::TelemetryReader& controllers)
{
    const auto now = Clock::now();
    if (now - last_ >= kPeriod)
    {
        last_ = now;
        server_->publish(host_metrics(host, controllers));
    }
}

} // namespace tactus
