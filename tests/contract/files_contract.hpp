#pragma once

#include <catch2/catch.hpp>
#include <cerrno>

#include "daemon/world/files.hpp"

namespace glidehelm::test {

/// What every Files must do, the machine's and the one in memory. `root` is an existing, empty folder.
inline void check_files_contract(world::Files& files, const std::string& root) {
  using world::Folder;
  const auto code = [](const auto& result) { return result ? 0 : result.error().code; };
  const auto names = [](Folder& folder) { return folder.list().value(); };
  using Names = std::vector<std::string>;

  CHECK(code(files.open_folder(root + "/none")) == ENOENT);
  const auto a = files.make_folder(root + "/a", 0750).value();
  const auto b = files.make_folder(root + "/b", 0750).value();
  CHECK(files.make_folder(root + "/a", 0750).value()->stat_self().value().inode == a->stat_self().value().inode);
  CHECK(a->path() == root + "/a");
  CHECK(a->stat_self().value().folder);
  CHECK(a->stat_self().value().device == b->stat_self().value().device);
  CHECK(a->stat_self().value().inode != b->stat_self().value().inode);
  CHECK(a->stat_self().value().mode == 0750);
  CHECK(code(files.make_folder(root + "/none/deeper", 0750)) == ENOENT);

  // create
  const auto made = a->create("one", "first", 0640).value();
  CHECK(made.regular);
  CHECK_FALSE(made.folder);
  CHECK(made.size == 5);
  CHECK(made.links == 1);
  CHECK(made.mode == 0640);
  CHECK(code(a->create("one", "again", 0640)) == EEXIST);
  CHECK(a->read("one", 5).value() == "first");
  CHECK(code(a->read("one", 4)) == EFBIG);
  CHECK(code(a->read("none", 4)) == ENOENT);
  CHECK(code(a->stat("none")) == ENOENT);
  CHECK(a->stat("one").value().inode == made.inode);
  CHECK(a->create("empty", "", 0640).value().size == 0);
  CHECK(names(*a) == Names{"empty", "one"});
  CHECK(code(a->unlink("none")) == ENOENT);
  CHECK(a->unlink("empty"));

  // by path
  CHECK(files.read(root + "/a/one", 100).value() == "first");
  CHECK(code(files.read(root + "/a/none", 100)) == ENOENT);
  CHECK(code(files.read(root + "/a/one", 4)) == EFBIG);
  CHECK(files.stat(root + "/a/one").value().size == 5);
  CHECK(code(files.stat(root + "/a/none")) == ENOENT);
  CHECK(files.stat(root + "/a").value().folder);
  CHECK(files.glob(root + "/a/*ne") == Names{root + "/a/one"});
  CHECK(files.glob(root + "/a/one") == Names{root + "/a/one"});
  CHECK(files.glob(root + "/a/none").empty());
  CHECK_FALSE(files.scratch().empty());

  // open and map: the bytes stay when the name gets others
  const auto opened = a->open("one").value();
  const auto mapped = files.map(root + "/a/one").value();
  CHECK(code(a->open("none")) == ENOENT);
  CHECK(code(files.map(root + "/a/none")) == ENOENT);
  CHECK(a->create("two", "second", 0640));
  CHECK(a->rename_over("two", *a, "one"));
  CHECK(opened->read_all(100).value() == "first");
  CHECK(opened->read_all(100).value() == "first");
  CHECK(code(opened->read_all(4)) == EFBIG);
  CHECK(std::string(reinterpret_cast<const char*>(mapped->bytes().data()), mapped->bytes().size()) == "first");
  CHECK(a->read("one", 100).value() == "second");
  CHECK(names(*a) == Names{"one"});

  // rename, over two folders, keeps the inode
  const auto inode = a->stat("one").value().inode;
  CHECK(a->rename_new("one", *b, "moved"));
  CHECK(names(*a).empty());
  CHECK(b->stat("moved").value().inode == inode);
  CHECK(a->create("one", "third", 0640));
  CHECK(code(a->rename_new("one", *b, "moved")) == EEXIST);
  CHECK(code(a->rename_new("none", *b, "other")) == ENOENT);
  CHECK(b->read("moved", 100).value() == "second");
  CHECK(a->read("one", 100).value() == "third");

  // exchange
  CHECK(a->exchange("one", *b, "moved"));
  CHECK(a->read("one", 100).value() == "second");
  CHECK(b->read("moved", 100).value() == "third");
  CHECK(a->stat("one").value().inode == inode);
  CHECK(code(a->exchange("one", *b, "none")) == ENOENT);
  CHECK(code(a->exchange("none", *b, "moved")) == ENOENT);
  CHECK(a->rename_over("one", *b, "moved"));
  CHECK(b->read("moved", 100).value() == "second");
  CHECK(names(*a).empty());
  CHECK(a->sync());

  // append and truncate
  {
    const auto log = a->append_to("log", true).value();
    CHECK(log->append("abc"));
    CHECK(log->append("def"));
    CHECK(log->sync());
  }
  CHECK(code(a->append_to("log", true)) == EEXIST);
  CHECK(code(a->append_to("none", false)) == ENOENT);
  {
    const auto log = a->append_to("log", false).value();
    CHECK(log->append("ghi"));
    CHECK(a->truncate("log", 4));
    CHECK(log->append("XY"));  // at the end that is now
  }
  CHECK(a->read("log", 100).value() == "abcdXY");
  CHECK(code(a->truncate("none", 0)) == ENOENT);

  // locks
  auto lock = a->lock("lock").value();
  CHECK(code(a->lock("lock")) == EAGAIN);
  CHECK(a->lock("other"));
  lock.reset();
  CHECK(a->lock("lock"));

  // may names be moved? nothing is left behind by asking
  CHECK(a->check_moves_to(*b));
  CHECK(names(*b) == Names{"moved"});
  CHECK(names(*a) == Names{"lock", "log", "other"});
}

}  // namespace glidehelm::test
