#include "core/mission/delivery.hpp"

#include <catch2/catch.hpp>

using namespace glidehelm;
using namespace glidehelm::mission;

namespace {

QueuedFile file_to(double lat, const char* key = "sim01/t1") {
  QueuedFile f{key, "goto_l10.ma", "bytes", {}};
  f.list.points = {{geo_point(lat, -15), model::WaypointRole::aim}, {geo_point(29, -15.5), model::WaypointRole::goal}};
  return f;
}

}  // namespace

TEST_CASE("a file comes from queued over sending, gone and re-read to flying") {
  FileOnItsWay file;
  CHECK(file.state() == Delivery::none);
  file.queued(file_to(28.5));
  CHECK(file.state() == Delivery::queued);
  CHECK(file.transfer_began());
  CHECK_FALSE(file.transfer_began());
  CHECK(file.state() == Delivery::sending);
  CHECK(file.in_folder());
  CHECK(file.seen_no_file());
  CHECK(file.state() == Delivery::gone);
  CHECK_FALSE(file.transfer_ended());
  CHECK(file.list_reread());
  CHECK(file.state() == Delivery::reread);
  CHECK(file.waypoint_heard(geo_point(28.5, -15)));
  CHECK(file.state() == Delivery::flying);
  CHECK(file.number_of(geo_point(28.5, -15)) == 1);
}

TEST_CASE("a waypoint proves nothing while the file still lies in the folder, nor after another list took its place") {
  FileOnItsWay file;
  file.queued(file_to(28.5));
  CHECK_FALSE(file.waypoint_heard(geo_point(28.5, -15)));
  CHECK_FALSE(file.list_reread());
  CHECK(file.seen_foreign());
  CHECK(file.state() == Delivery::overruled);
  CHECK_FALSE(file.waypoint_heard(geo_point(28.5, -15)));
}

TEST_CASE("a waypoint is the printed one to within two roundings of a ten-thousandth of a minute, not more") {
  for (const double off : {1.4e-4, -1.4e-4}) {
    FileOnItsWay file;
    file.queued(file_to(28.5));
    file.seen_no_file();
    CHECK(file.waypoint_heard(geo_point(28.5 + off / 60, -15)));
  }
  FileOnItsWay file;
  file.queued(file_to(28.5));
  file.seen_no_file();
  CHECK_FALSE(file.waypoint_heard(geo_point(28.5 + 2e-4 / 60, -15)));
}

TEST_CASE("a waypoint of both lists proves the new one only after the re-read was heard") {
  const auto goal = geo_point(29, -15.5);
  FileOnItsWay file;
  file.queued(file_to(28.4, "sim01/t0"));
  file.queued(file_to(28.5));
  file.seen_no_file();
  CHECK_FALSE(file.waypoint_heard(goal));
  CHECK(file.of_older_list(geo_point(28.4, -15)));
  CHECK_FALSE(file.of_older_list(goal));
  file.list_reread();
  CHECK(file.waypoint_heard(goal));
}

TEST_CASE("a transfer that did not end with its call has failed: the file is queued") {
  FileOnItsWay file;
  file.queued(file_to(28.5));
  file.transfer_began();
  CHECK(file.call_ended());
  CHECK(file.state() == Delivery::queued);
  file.transfer_began();
  file.transfer_ended();
  CHECK_FALSE(file.call_ended());
  CHECK(file.seen_in_folder());  // the dockserver left it there: it will be sent again
  CHECK(file.state() == Delivery::queued);
}

TEST_CASE("a failed transfer leaves the file queued, and unknown once it is gone from the folder") {
  FileOnItsWay file;
  CHECK_FALSE(file.transfer_failed());  // none of ours was sent
  file.queued(file_to(28.5));
  file.transfer_began();
  CHECK(file.transfer_failed());
  CHECK(file.state() == Delivery::queued);
  CHECK_FALSE(file.seen_in_folder());  // where it was known to be
  CHECK(file.seen_no_file());
  CHECK(file.state() == Delivery::unknown);
  CHECK_FALSE(file.list_reread());  // perhaps of half a list
  CHECK(file.state() == Delivery::unknown);
  CHECK(file.waypoint_heard(geo_point(28.5, -15)));
  CHECK(file.state() == Delivery::flying);
  CHECK_FALSE(file.transfer_failed());  // it was whole, and is not what failed now
}

TEST_CASE("a failed transfer that is made good goes on as any other") {
  FileOnItsWay file;
  file.queued(file_to(28.5));
  file.transfer_began();
  file.transfer_failed();
  SECTION("from the folder") {
    CHECK(file.transfer_began());
    CHECK(file.seen_no_file());
  }
  SECTION("after the folder was found empty") {
    file.seen_no_file();
    CHECK(file.transfer_ended());
  }
  CHECK(file.state() == Delivery::gone);
  CHECK(file.list_reread());
}

TEST_CASE("a failure that is heard after the file had gone makes it unknown, whatever came between") {
  FileOnItsWay file;
  file.queued(file_to(28.5));
  file.seen_no_file();
  SECTION("at once") {}
  SECTION("after a re-read") { file.list_reread(); }
  CHECK(file.transfer_failed());
  CHECK(file.state() == Delivery::unknown);
  CHECK(file.seen_in_folder());  // the dockserver put it back
  CHECK(file.state() == Delivery::queued);
}
