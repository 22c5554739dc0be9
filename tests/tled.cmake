# tests of tled
byssus_test(unit/tled/test_static base tled)
