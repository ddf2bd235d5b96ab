#include "daemon/verify/dossier_json.hpp"

#include "daemon/verify/values_json.hpp"

namespace glidehelm::verify {

template <class F>
void members(InputFile& i, F&& f) {
  f("path", i.path), f("hash", i.hash);
}
template <class F>
void members(SourceFile& s, F&& f) {
  f("name", s.name), f("grid", s.grid), f("options", s.options), f("region", s.region);
  f("from_s", s.from_s), f("to_s", s.to_s);
}
template <class F>
void members(VerifyRequest& r, F&& f) {
  f("dossier", r.dossier), f("grid", r.grid), f("grid_options", r.grid_options);
  f("sources", r.sources), f("seams", r.seams), f("analytic", r.analytic);
  f("analytic_start_ms", r.analytic_start), f("analytic_box", r.analytic_box), f("coast", r.coast);
  f("bathymetry", r.bathymetry), f("least_depth_m", r.least_depth);
  f("keep_in", r.keep_in), f("keep_out", r.keep_out);
}

namespace {

using nlohmann::json;

constexpr const char* kDossierSchema = "glidehelm/dossier/v1";
constexpr const char* kVerdictSchema = "glidehelm/verdict/v1";
constexpr const char* kRequestSchema = "glidehelm/verify-request/v1";

template <class T>
std::string document(const T& value, const char* schema) {
  json j = values::write(value);
  j["schema"] = schema;
  return j.dump();
}

template <class T>
Expected<T, JsonProblem> guarded(std::string_view text, const char* schema) {
  try {
    const json j = json::parse(text);
    if (!j.is_object() || j.value("schema", "") != schema)
      return unexpected(JsonProblem{std::string{"the document is not "} + schema});
    auto value = values::guarded<T>(j);
    if (!value) return unexpected(JsonProblem{value.error()});
    return std::move(value).value();
  } catch (const std::exception& e) {
    return unexpected(JsonProblem{e.what()});
  }
}

}  // namespace

std::optional<Sha256> grid_identity(std::string_view first_bytes) {
  if (first_bytes.size() < kGridHead) return std::nullopt;
  return Sha256::of(first_bytes.substr(0, kGridHead));
}

std::string to_json(const safety::Dossier& dossier) { return document(dossier, kDossierSchema); }
std::string to_json(const safety::Verdict& verdict) { return document(verdict, kVerdictSchema); }
std::string to_json(const VerifyRequest& request) { return document(request, kRequestSchema); }

Expected<safety::Dossier, JsonProblem> dossier_from_json(std::string_view text) {
  return guarded<safety::Dossier>(text, kDossierSchema);
}
Expected<safety::Verdict, JsonProblem> verdict_from_json(std::string_view text) {
  return guarded<safety::Verdict>(text, kVerdictSchema);
}
Expected<VerifyRequest, JsonProblem> request_from_json(std::string_view text) {
  return guarded<VerifyRequest>(text, kRequestSchema);
}

}  // namespace glidehelm::verify
