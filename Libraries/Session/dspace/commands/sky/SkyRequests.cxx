// Rotations of reference frames, bodies in the sky, sub-points.
#include <dspace/Checks.h>
#include <dspace/commands/sky/SkyPlaces.h>
#include <dspace/commands/sky/SkyTools.h>
#include <dspace/ephemeris/BodyNames.h>
#include <dspace/ephemeris/Fallbacks.h>
#include <dspace/messages/Convert.h>
#include <dspace/sky/SkyEclipse.h>
#include <dspace/sky/SubPoints.h>
#include <dspace/state/TerrainObject.h>
#include <dspace/time/UtcText.h>

namespace dspace::session {
namespace {

// TDB [s past J2000] of 1960-01-01T12:00 UTC: UTC began half a day before.
constexpr double Utc1960 = -1262260800.0;

template<class Message>
std::vector<double> TimesOf(const Context& context, const Message& command) {
  if (command.time_s().empty()) {
    return {context.GetScene().Time()};
  }
  return {command.time_s().begin(), command.time_s().end()};
}

void AddRows(const Eigen::Matrix3d& m, google::protobuf::RepeatedField<double>* out) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      out->Add(m(row, column));
    }
  }
}

void TurnFrames(const Context& context, v1::TurnFrames& command) {
  const Frames& frames = context.scene->sky.kernels->GetFrames();
  const int from = frames.FrameId(command.from());
  const int to = frames.FrameId(command.to());
  const std::vector<double> times = TimesOf(context, command);
  v1::FrameTurnsReply* reply = context.reply.mutable_frame_turns();
  for (const double tdb : times) {
    FallbackScope::Begin(tdb);
    const StateTurn turn = frames.Turn(from, to, tdb);
    AddRows(turn.rotation, reply->mutable_rotation());
    if (command.rates()) {
      AddRows(turn.rate, reply->mutable_rate());
    }
  }
  for (const Frames::Step& step : frames.Explain(command.from(), command.to(), times[0])) {
    v1::FrameTurnsReply::Step* out = reply->add_step();
    out->set_frame(step.frame);
    out->set_relative(step.relative);
    out->set_source(step.source);
    out->set_accuracy(step.accuracy);
  }
}

Correction CorrectionOf(v1::Ephemeris::Correction correction) {
  switch (correction) {
  case v1::Ephemeris::GEOMETRIC:
    return Correction::None;
  case v1::Ephemeris::LIGHT_TIME:
    return Correction::Converged;
  case v1::Ephemeris::APPARENT:
    return Correction::ConvergedStar;
  case v1::Ephemeris::LIGHT_TIME_ONCE:
    return Correction::LightTime;
  case v1::Ephemeris::APPARENT_ONCE:
    return Correction::LightTimeStar;
  default:
    Reject("command ephemeris", "the correction is " + std::to_string(int(correction)) +
                                    "; accepted: GEOMETRIC, LIGHT_TIME, APPARENT, "
                                    "LIGHT_TIME_ONCE, APPARENT_ONCE");
  }
}

void FindStates(const Context& context, v1::Ephemeris& command) {
  const dspace::Ephemeris& ephemeris = context.scene->sky.kernels->GetEphemeris();
  dspace::Ephemeris::Query query;
  query.target = ephemeris.Names().IdOf(command.target());
  query.observer = ephemeris.Names().IdOf(command.observer());
  query.frame = command.axes().empty() ? "J2000" : command.axes();
  query.correction = CorrectionOf(command.correction());
  const std::vector<double> times = TimesOf(context, command);
  std::vector<dspace::Ephemeris::Result> results(times.size());
  ephemeris.FindMany(query, times.data(), times.size(), results.data());
  v1::EphemerisReply* reply = context.reply.mutable_ephemeris();
  for (const dspace::Ephemeris::Result& result : results) {
    for (const Eigen::Vector3d& v : {result.state.position, result.state.velocity}) {
      reply->mutable_state()->Add(v.data(), v.data() + 3);
    }
    reply->add_light_time_s(result.lightTime);
  }
  for (const dspace::Ephemeris::Used& used : ephemeris.Explain(query, times[0])) {
    v1::EphemerisReply::Source* source = reply->add_source();
    source->set_body(ephemeris.Names().NameOf(used.body));
    source->set_center(ephemeris.Names().NameOf(used.center));
    source->set_source(used.source);
    source->set_accuracy(used.accuracy);
    for (const std::string& name : used.hidden) {
      source->add_hidden(name);
    }
  }
}

void FindSubPoints(const Context& context, v1::FindSubPoints& command) {
  const KernelSet& kernels = *context.scene->sky.kernels;
  const dspace::Ephemeris& ephemeris = kernels.GetEphemeris();
  const int body = ephemeris.Names().IdOf(command.body());
  const std::string frame =
      command.frame().empty() ? kernels.GetFrames().Table().BodyFixed(body).name : command.frame();
  std::optional<int> observer;
  if (!command.observer().empty()) {
    observer = ephemeris.Names().IdOf(command.observer());
  } else if (command.below_observer()) {
    Reject("body '" + command.body() + "'",
           "the point below an observer is asked for, without an observer; accepted: one");
  }
  const Correction correction = command.correction().empty()
                                    ? Correction::ConvergedStar
                                    : dspace::CorrectionOf(command.correction());
  v1::SubPointsReply* reply = context.reply.mutable_sub_points();
  reply->set_frame(frame);
  for (const double tdb : TimesOf(context, command)) {
    FallbackScope::Begin(tdb);
    const SubPoint point =
        command.below_observer()
            ? SubObserverPoint(ephemeris, kernels.GetFrames(), body, frame, *observer, tdb,
                               correction)
            : SubSolarPoint(ephemeris, kernels.GetFrames(), body, frame, tdb, observer, correction);
    reply->add_point(point.longitude_deg);
    reply->add_point(point.latitude_deg);
    reply->add_point(point.geodetic_latitude_deg);
    reply->mutable_position()->Add(point.position.data(), point.position.data() + 3);
  }
}

void ConvertTimes(const Context& context, v1::ConvertTimes& command) {
  const TimeScales& scales = context.scene->sky.kernels->Scales();
  const TimeScale scale = command.scale().empty() ? TimeScale::Utc : TimeScaleOf(command.scale());
  v1::TimesReply* reply = context.reply.mutable_times();
  for (const std::string& text : command.text()) {
    reply->add_time_s(TdbFromText(text, scales));
  }
  for (const double tdb : command.time_s()) {
    reply->add_time_s(tdb);
  }
  std::string expired;
  for (int i = 0; i < reply->time_s_size(); ++i) {
    const double tdb = reply->time_s(i);
    if (i < command.text_size() && tdb < Utc1960 && scale == TimeScale::Utc) {
      reply->add_utc(""); // a text in another scale
      continue;
    }
    reply->add_utc(TimeText(tdb, scale, scales, int(command.decimals())));
    if (tdb < Utc1960) {
      continue;
    }
    const int day = scales.UtcFromTai(scales.Convert(tdb, TimeScale::Tdb, TimeScale::Tai)).mjd;
    if (expired.empty()) {
      expired = scales.GetLeapSeconds().WarningAt(day);
    }
  }
  if (!expired.empty()) {
    context.reply.add_warning(expired);
  }
}

void SkyState(const Context& context, v1::SkyState& command) {
  const SkyMotions& sky = context.scene->sky;
  v1::SkyPlace asked;
  switch (command.from_case()) {
  case v1::SkyState::kPlace:
    *asked.mutable_place() = command.place();
    break;
  case v1::SkyState::kSite:
    *asked.mutable_site() = command.site();
    break;
  case v1::SkyState::kCelestial:
    *asked.mutable_celestial() = command.celestial();
    break;
  default:
    break;
  }
  asked.set_body(command.body());
  const dspace::SkyPlace place = PlaceUnderSky(context, asked, "command sky_state");
  const dspace::Ephemeris& ephemeris = sky.kernels->GetEphemeris();
  const double tdb = command.has_time_s() ? command.time_s() : context.GetScene().Time();
  std::vector<std::string> targets(command.target().begin(), command.target().end());
  if (targets.empty()) {
    targets.push_back("sun");
  }
  v1::SkyReply* reply = context.reply.mutable_sky();
  for (const std::string& target : targets) {
    const int id = ephemeris.Names().IdOf(target);
    const Frames& frames = sky.kernels->GetFrames();
    const SkyBody seen = Look(ephemeris, frames, place, id, tdb);
    v1::SkyReply::Body* body = reply->add_body();
    body->set_name(target);
    body->set_azimuth_deg(seen.direction.azimuth_deg);
    body->set_elevation_deg(seen.direction.elevation_deg);
    body->set_range(seen.range);
    body->set_radius_deg(seen.radius_deg);
    body->set_lit_fraction(id == BodySun ? SunLeftOver(ephemeris, frames, place, seen, tdb)
                                         : seen.litFraction);
  }
}

} // namespace

void AddSkyRequests(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kTurnFrames, &C::mutable_turn_frames, TurnFrames);
  registry.Add(C::kFindSubPoints, &C::mutable_find_sub_points, FindSubPoints);
  registry.Add(C::kConvertTimes, &C::mutable_convert_times, ConvertTimes);
  registry.Add(C::kEphemeris, &C::mutable_ephemeris, FindStates);
  registry.Add(C::kSkyState, &C::mutable_sky_state, SkyState);
}

} // namespace dspace::session
