// Results of measuring machines read: what they may look like, what is refused where.
#include <gtest/gtest.h>

#include "geometry/base/angle.h"
#include "geometry/base/plain_text.h"
#include "geometry/inspection/dmis.h"
#include "geometry/inspection/point_file.h"
#include "tests/support/inspection_points.h"
#include "tests/support/sample_gears.h"

namespace toothpath {
namespace {

using inspection::parse_dmis_results;
using inspection::parse_plain_points;

std::string error_of(const Result<inspection::PointFile>& read) { return read ? "taken" : read.error().text(); }

TEST(PlainPoints, AnySeparatorCommentsAndNormals) {
  for (const char* text : {"1.5 -2 3\n4 5 6\n", "1.5,-2,3\r\n4,5,6\r\n", "1.5;-2;3\n4;5;6", "1.5\t-2\t+3\n4\t5\t6\n",
                           "# points\n\n  1.5 , -2 ,  3 \n// more\n4 , 5 , 6\n; end\n", "X Y Z\n1.5 -2 3\n4e0 5 6\n",
                           "\xef\xbb\xbfx,y,z\n1.5,-2,3\n4,5,6\n", "% cloud\n1.5 -2. 3.0\n4 5 .6e1\n"}) {
    const auto read = parse_plain_points(text, "p.txt");
    ASSERT_TRUE(read) << text << read.error().text();
    ASSERT_EQ(read->points.size(), 2u) << text;
    EXPECT_EQ(read->points[0].p, Vec3(1.5, -2, 3)) << text;
    EXPECT_EQ(read->points[1].p, Vec3(4, 5, 6)) << text;
    EXPECT_FALSE(read->points[0].n);
  }
  const auto normals = parse_plain_points("# x y z i j k\n 1 2 3 0.6 0 -0.8\n", "p.txt");
  ASSERT_TRUE(normals && normals->points[0].n);
  EXPECT_LT((*normals->points[0].n - Vec3(0.6, 0, -0.8)).norm(), 1e-15);
  EXPECT_EQ(normals->points[0].at.line, 2);
  EXPECT_EQ(normals->points[0].at.column, 2);
}

TEST(PlainPoints, WrongLinesAreRefusedAtTheirPlace) {
  EXPECT_EQ(error_of(parse_plain_points("", "p.txt")),
            "p.txt:1:1: error: no measured point: lines x y z or x y z i j k are needed");
  EXPECT_EQ(error_of(parse_plain_points("# nothing\n\n", "p.txt")).substr(0, 14), "p.txt:2:1: err");
  EXPECT_EQ(error_of(parse_plain_points("1 2\n", "p.txt")),
            "p.txt:1:1: error: 2 columns, must be 3 (x y z) or 6 (x y z i j k)");
  EXPECT_EQ(error_of(parse_plain_points("1 2 3\n1 2 3 0 0 1\n", "p.txt")),
            "p.txt:2:1: error: 6 columns, but 3 in line 1");
  EXPECT_EQ(error_of(parse_plain_points("1 2 3\n1 two 3\n", "p.txt")),
            "p.txt:2:3: error: y = \"two\" is no finite number");
  EXPECT_EQ(error_of(parse_plain_points("1,,3\n", "p.txt")), "p.txt:1:3: error: y = \"\" is no finite number");
  EXPECT_EQ(error_of(parse_plain_points("1 2 nan\n", "p.txt")), "p.txt:1:5: error: z = \"nan\" is no finite number");
  EXPECT_EQ(error_of(parse_plain_points("1 2 1e999\n", "p.txt")),
            "p.txt:1:5: error: z = \"1e999\" is no finite number");
  EXPECT_EQ(error_of(parse_plain_points("1 2 3 0 0 2\n", "p.txt")),
            "p.txt:1:7: error: the normal (0, 0, 2) has length 2, must be 1 within 0.01");
  EXPECT_EQ(error_of(parse_plain_points("1.5;2,25;1.234,5\n", "p.txt")),
            "p.txt:1:10: error: z = \"1.234,5\" is no finite number");
  EXPECT_EQ(error_of(parse_plain_points("29.6 1.4 -15.9 0.003\n", "p.txt")),
            "p.txt:1:1: error: 4 columns, must be 3 (x y z) or 6 (x y z i j k); one more ahead of them is a point's "
            "number, and \"29.6\" is none");
  EXPECT_EQ(error_of(parse_plain_points("7 1.5 2 3\n8.5 1.5 2 3\n", "p.txt")),
            "p.txt:2:1: error: \"8.5\" is no number of a point; that of line 1 is one, x y z follow it");
  EXPECT_EQ(error_of(parse_plain_points("X [mm];Y [in];Z [mm]\n1;2;3\n", "p.txt")),
            "p.txt:1:8: error: \"X [mm]\" and \"Y [in]\" are in different units");
  EXPECT_EQ(error_of(parse_plain_points("X [ell];Y [ell];Z [ell]\n1;2;3\n", "p.txt")),
            "p.txt:1:1: error: \"X [ell]\": the unit \"ell\" is none of mm, um, cm, m, inch");
  EXPECT_EQ(error_of(parse_plain_points("X;Y;Z;Dev\n1;2;3;4\n", "p.txt")),
            "p.txt:1:7: error: column \"Dev\": behind x, y, z only i, j, k (the normal) are read; leave it out");
  EXPECT_EQ(error_of(parse_plain_points("Point;X;Y;Z\n1;2;3\n", "p.txt")),
            "p.txt:2:1: error: 3 columns, but 4 in line 1");
}

TEST(PlainPoints, WhatMachinesAndSpreadsheetsPutAroundTheNumbers) {
  for (const char* text :
       {"1 1.5 -2 3\n2 4 5 6\n", "P1\t1.5\t-2\t3\nP2\t4\t5\t6\n", "PT 01;1,5;-2;3\nPT 02;4;5;6\n",
        "\"1.5\",\"-2\",\"3\"\n\"4\",\"5\",\"6\"\n", "\"1,5\",\"-2,0\",\"3\"\n4,5,6\n", "1,5;-2;3\n4;5;6;\n",
        "1,5 -2,0 3,00\n4,0 5,0 6,0\n", "sep=;\nX;Y;Z\n1,5;-2;3\n4;5;6\n", "X,Y,Z,,\n1.5,-2,3,,\n4,5,6,,\n,,,,\n",
        "Point;X [mm];Y [mm];Z [mm]\n1;1.5;-2;3\n2;4;5;6\n", "No. X(mm) Y(mm) Z(mm)\n1 1.5 -2 3\n2 4 5 6\n",
        "X [mm] Y [mm] Z [mm]\n1.5 -2 3\n4 5 6\n", "\"x/mm\",\"y/mm\",\"z/mm\"\n1.5,-2,3\n4,5,6\n",
        "Name\tX_mm\tY_mm\tZ_mm\na\t1.5\t-2\t3\nb\t4\t5\t6\n", "Z [cm];Y [cm];X [cm]\n0,3;-0,2;0,15\n0,6;0,5;0,4\n",
        "x [\xC2\xB5m],y [\xC2\xB5m],z [\xC2\xB5m]\n1500,-2000,3000\n4000,5000,6000\n"}) {
    const auto read = parse_plain_points(text, "p.txt");
    ASSERT_TRUE(read) << text << read.error().text();
    ASSERT_EQ(read->points.size(), 2u) << text;
    EXPECT_LT((read->points[0].p - Vec3(1.5, -2, 3)).norm(), 1e-12) << text;
    EXPECT_LT((read->points[1].p - Vec3(4, 5, 6)).norm(), 1e-12) << text;
  }
  const auto inch = parse_plain_points("Pt;X [in];Y [in];Z [in];I;J;K\n1;1;-2;3;0,6;0;-0,8\n", "p.txt");
  ASSERT_TRUE(inch) << inch.error().text();
  EXPECT_LT((inch->points[0].p - 25.4 * Vec3(1, -2, 3)).norm(), 1e-12);
  EXPECT_LT((*inch->points[0].n - Vec3(0.6, 0, -0.8)).norm(), 1e-15);
}

TEST(PlainText, AnyEncodingAndEndOfLineGivesTheSameLines) {
  const std::string wanted = "X [\xC2\xB5m]\n1\n\n\xF0\x9F\x99\x82\n";
  const std::u16string wide = u"X [\u00B5m]\r\n1\r\r\U0001F642\n";
  std::string little = "\xFF\xFE", big = "\xFE\xFF";
  for (const char16_t c : wide) {
    little += {char(c & 0xFF), char(c >> 8)};
    big += {char(c >> 8), char(c & 0xFF)};
  }
  for (const std::string& bytes :
       {"\xEF\xBB\xBF" + wanted, wanted + "\xEF\xBB\xBF", little, little + "\xFF\xFE", big, little.substr(2),
        big.substr(2), std::string("X [\xC2\xB5m]\r1\r\n\r\xF0\x9F\x99\x82\r")}) {
    const auto text = plain_text(bytes, "f");
    ASSERT_TRUE(text) << text.error().text();
    EXPECT_EQ(*text, wanted);
  }
  EXPECT_EQ(plain_text(little + "x", "f").error().text(), "f:3:1: error: this is UTF-16 that ends within a character");
  EXPECT_FALSE(plain_text(std::string("\xFF\xFE\x00\xDC", 4), "f")) << "half a character";
  EXPECT_EQ(*plain_text("", "f"), "");
}

TEST(DmisResults, ActualPointsInTheFormsThatMachinesWrite) {
  const std::string text =
      "DMISMN/'result, FA(X)=FEAT/POINT,CART,9,9,9,0,0,1',05.2\n"
      "$$ FA(NO)=FEAT/POINT,CART,9,9,9,0,0,1\n"
      "UNITS/MM,ANGDEC\r\n"
      "F(P1)=FEAT/POINT,CART,1,2,3,0,0,1\n"
      "OUTPUT/FA(P1)\n"
      "FA(P1)=FEAT/POINT,CART,1.01,$\n"
      "  2.02, 3.03,0.,0.,1.  $$ measured\n"
      "fa( pol 2 ) = feat/point , pol , 2, 90, +5, 0,-1,0\n"
      "FA(C1)=FEAT/CIRCLE,INNER,CART,0,0,0,0,0,1,50\n"
      "FA(G)=FEAT/GSURF\n"
      "PTDATA/CART,7,8,9\n"
      "PTDATA/CART,7,8,10,1,0,0\n"
      "TA(T1)=TOL/PROFP,0.012,OUTOL\n"
      "UNITS/INCH,ANGRAD\n"
      "FA(I)=FEAT/POINT,CART,1,0,-1,0,0,-1\n"
      "ENDFIL\n";
  EXPECT_TRUE(inspection::looks_like_dmis(text));
  const auto read = parse_dmis_results(text, "r.dmo");
  ASSERT_TRUE(read) << read.error().text();
  ASSERT_EQ(read->points.size(), 5u);
  EXPECT_EQ(read->other_features, 2u);
  const auto& p = read->points;
  EXPECT_EQ(p[0].p, Vec3(1.01, 2.02, 3.03));
  EXPECT_EQ(p[0].label, "P1");
  EXPECT_EQ(p[0].at.line, 6);
  EXPECT_EQ(*p[0].n, Vec3(0, 0, 1));
  EXPECT_EQ(p[1].label, "pol 2");
  EXPECT_LT((p[1].p - Vec3(0, 2, 5)).norm(), 1e-12);
  EXPECT_EQ(*p[1].n, Vec3(0, -1, 0));
  EXPECT_EQ(p[2].p, Vec3(7, 8, 9));
  EXPECT_FALSE(p[2].n);
  EXPECT_EQ(*p[3].n, Vec3(1, 0, 0));
  EXPECT_LT((p[4].p - Vec3(25.4, 0, -25.4)).norm(), 1e-12);
}

TEST(DmisResults, OurOwnProgramWithItsResultsComesBack) {
  const auto gear = test::made(test::quarter_dhfg());
  const auto grid = test::grid_of(gear, 5, 9);
  std::string text = inspection::inspection_dmis(gear, grid, "job");
  text.erase(text.rfind("ENDFIL"));
  for (const auto& p : grid) {
    const Vec3 q = p.p + 0.01 * p.n;
    text += fmt::format("FA(Z{}{}_R{}C{})=FEAT/POINT,CART,{:.6f},{:.6f},{:.6f},$\n{:.8f},{:.8f},{:.8f}\n", p.zone,
                        p.side > 0 ? 'P' : 'M', p.row, p.column, q.x(), q.y(), q.z(), p.n.x(), p.n.y(), p.n.z());
  }
  const auto read = parse_dmis_results(text + "ENDFIL\n", "r.dmo");
  ASSERT_TRUE(read) << read.error().text();
  ASSERT_EQ(read->points.size(), grid.size());
  for (std::size_t k = 0; k < grid.size(); ++k)
    EXPECT_LT((read->points[k].p - grid[k].p - 0.01 * grid[k].n).norm(), 1e-6);
  // The program alone holds nominal points only.
  EXPECT_NE(
      error_of(parse_dmis_results(inspection::inspection_dmis(gear, grid, "job"), "r.dmo")).find("no measured point"),
      std::string::npos);
}

TEST(DmisResults, WrongStatementsAreRefusedAtTheirPlace) {
  EXPECT_EQ(error_of(parse_dmis_results("UNITS/MM\n", "r.dmo")),
            "r.dmo:1:1: error: no measured point: statements FA(..)=FEAT/POINT,CART,x,y,z,i,j,k are needed");
  EXPECT_EQ(error_of(parse_dmis_results("FA(A)=FEAT/POINT,CART,1,2,3\n", "r.dmo")),
            "r.dmo:1:18: error: FEAT/POINT of A has 3 values, must be 6: x,y,z,i,j,k");
  EXPECT_EQ(error_of(parse_dmis_results("\nFA(A)=FEAT/POINT,CART,$\n1,2,x,0,0,1\n", "r.dmo")),
            "r.dmo:3:5: error: FEAT/POINT of A: \"x\" is no finite number");
  EXPECT_EQ(error_of(parse_dmis_results("FA(A)=FEAT/POINT,CYL,1,2,3,0,0,1\n", "r.dmo")),
            "r.dmo:1:18: error: FEAT/POINT of A is in \"CYL\", must be CART or POL");
  EXPECT_EQ(error_of(parse_dmis_results("FA(A)=FEAT/POINT\n", "r.dmo")),
            "r.dmo:1:7: error: FEAT/POINT of A is in \"\", must be CART or POL");
  EXPECT_EQ(error_of(parse_dmis_results("FA(A)\n", "r.dmo")),
            "r.dmo:1:1: error: FA(..) lacks \"=FEAT/..\" behind its label");
  EXPECT_EQ(error_of(parse_dmis_results("UNITS/MILES\n", "r.dmo")),
            "r.dmo:1:7: error: UNITS/MILES is none of MM, CM, M, INCH, FEET");
  EXPECT_EQ(error_of(parse_dmis_results("UNITS/MM,ANGDMS\nFA(A)=FEAT/POINT,POL,1,2,3,0,0,1\n", "r.dmo")),
            "r.dmo:2:18: error: FEAT/POINT of A is polar in ANGDMS: angles must be ANGDEC or ANGRAD");
  EXPECT_EQ(error_of(parse_dmis_results("FA(A)=FEAT/POINT,CART,1,2,3,0,0,0\n", "r.dmo")),
            "r.dmo:1:29: error: the normal (0, 0, 0) has length 0, must be 1 within 0.01");
}

}  // namespace
}  // namespace toothpath
