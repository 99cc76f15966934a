#!/usr/bin/python3
"""Looks at reports in headless Chromium, as a user would: report_in_browser.py DIRECTORY.

DIRECTORY holds fine.html, failed.html, hostile.html, large.html, folded.html and empty.html (slow_report_test.cpp
writes them).
Ends with 0 where everything is as it should be, and says what isn't.
"""
import json
import os
import sys
import tempfile

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

faults = []


def check(holds, what):
    if not holds:
        faults.append(what)


def start_browser(home):
    # Everything that the browser keeps of its own goes where it is removed again.
    for name in ("HOME", "XDG_CONFIG_HOME", "XDG_CACHE_HOME", "XDG_DATA_HOME"):
        os.environ[name] = home
    options = Options()
    options.binary_location = "/usr/bin/chromium"
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                     "--disable-background-networking", "--no-first-run", "--window-size=1400,900",
                     "--user-data-dir=" + os.path.join(home, "profile")):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver", log_path=os.devnull), options=options)


class Page:
    def __init__(self, browser, directory, name):
        self.browser, self.name = browser, name
        browser.get("file://" + os.path.join(directory, name))

    def check(self, holds, what):
        check(holds, f"{self.name}: {what}")

    def details(self):
        return self.browser.find_element(By.ID, "details").text

    def box(self, name):
        for box in self.browser.find_elements(By.CSS_SELECTOR, ".box"):
            if box.find_element(By.CSS_SELECTOR, ".name").get_attribute("textContent") == name:
                return box
        raise AssertionError(f"{self.name}: no box is called {name}")

    def click(self, name):
        self.box(name).find_element(By.CSS_SELECTOR, ".name").click()

    def expect_details(self, *texts):
        shown = self.details()
        for text in texts:
            self.check(text in shown, f"the details don't show '{text}' but:\n{shown}")

    def end(self):
        """No errors in the console, and nothing loaded from outside of the page."""
        for line in self.browser.get_log("browser"):
            self.check(False, "the console says: " + line["message"])
        asked = []
        for entry in self.browser.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            # The browser's own pages load things, too.
            if message["method"] != "Network.requestWillBeSent" or not message["params"]["documentURL"].endswith("/" + self.name):
                continue
            asked.append(message["params"]["request"]["url"])
        self.check(asked, "the log of what is loaded doesn't have the page itself")
        for url in asked:
            self.check(url.startswith("data:") or url.endswith("/" + self.name), "the page asks for " + url[:200])


def look_at_fine(page):
    browser = page.browser
    page.expect_details("hit\n", "Simulate")  # what took longest is shown at first
    page.click("cells")
    page.expect_details("cells\n", "CVD", "input weights changed", "211 ms", "warning: 2 cells hold one node only", "12 sites",
                        "1 at their defaults", "seed", "weights.weights", "degree.sites")
    page.check("chosen" in page.box("cells").get_attribute("class"), "the box isn't marked as chosen")
    page.check("chosen" not in page.box("hit").get_attribute("class"), "the box chosen before is still marked")
    browser.execute_script("arguments[0].focus()", page.box("weights"))
    browser.switch_to.active_element.send_keys(Keys.ENTER)
    page.expect_details("weights\n", "3.2 ms")

    page.click("picture")
    page.expect_details("frame 1001", "frame 1004", "out/1001.png")
    [line for line in browser.find_elements(By.CSS_SELECTOR, "#details button") if line.text == "frame 1003"][0].click()
    page.expect_details("in frame 1003", "out/1003.png")
    [link for link in browser.find_elements(By.CSS_SELECTOR, "#details button") if link.text == "sheet.pictures"][0].click()
    page.expect_details("sheet\n", "/shots/vase/out/sheet.png")

    def column(number):
        return [row.find_elements(By.TAG_NAME, "td")[number].text for row in
                browser.find_elements(By.CSS_SELECTOR, "#nodes tbody tr") if row.is_displayed()]
    time = browser.find_element(By.XPATH, "//table[@id='nodes']//button[text()='time']")
    time.click()
    page.check(column(0)[:3] == ["hit", "picture", "degree"], f"sorted by time the table begins {column(0)[:3]}")
    time.click()
    page.check(column(0)[-1] == "hit", f"sorted the other way it ends with {column(0)[-1]}")
    browser.find_element(By.ID, "filter").send_keys("tess")
    page.check(column(0) == ["pieces"], f"'tess' leaves {column(0)}")
    browser.find_element(By.CSS_SELECTOR, "#nodes tbody tr[data-group='8'] button").click()
    page.expect_details("pieces\n")

    picture = browser.find_element(By.CSS_SELECTOR, "figure img")
    page.check(int(picture.get_property("naturalWidth")) == 2, "the picture isn't shown")

    drawing = browser.find_element(By.ID, "drawing")
    before = drawing.size["width"]
    browser.find_element(By.ID, "closer").click()
    page.check(drawing.size["width"] > before, "+ doesn't enlarge the drawing")
    browser.find_element(By.ID, "whole").click()
    frame = browser.find_element(By.ID, "graph").size
    page.check(drawing.size["height"] <= frame["height"] and drawing.size["width"] <= frame["width"],
               "'whole' doesn't show the whole graph")


def look_at_failed(page):
    page.expect_details("pieces\n", "failed", "the cells have no tetrahedra")
    page.click("sheet")
    page.expect_details("sheet\n", "skipped")
    page.browser.find_element(By.CSS_SELECTOR, ".errors button").click()
    page.expect_details("pieces\n")


def look_at_hostile(page):
    page.check(page.browser.execute_script("return window.hurt === undefined"), "a text was run as a script")
    page.check(not page.browser.find_elements(By.CSS_SELECTOR, "body b.evil"), "a text was read as HTML")
    for box in page.browser.find_elements(By.CSS_SELECTOR, ".box"):
        page.browser.execute_script("arguments[0].dispatchEvent(new MouseEvent('click', {bubbles: true}))", box)
    page.check("<b class=evil>" in page.details(), "the details don't show the text as it is")
    page.check(page.browser.execute_script("return window.hurt === undefined"), "the details ran a text as a script")
    page.check(not page.browser.find_elements(By.CSS_SELECTOR, "body b.evil"), "the details read a text as HTML")


def look_at_large(page):
    page.check(len(page.browser.find_elements(By.CSS_SELECTOR, ".box")) == 2000, "boxes are missing")
    page.browser.find_element(By.CSS_SELECTOR, "#nodes tbody tr[data-group='1234'] button").click()
    page.expect_details("node1234\n")


def look_at_folded(page):
    page.check("Too much for one page: " in page.browser.find_element(By.TAG_NAME, "header").text,
               "the summary doesn't say that something is left out")
    page.click("a")
    page.expect_details("in frame 777", "5000 ms", "50000 FRAMES AND WEDGES", " more are not shown: too much for one page")


def no_overlaps(page):
    """No text of a box leaves it, in the fonts that the browser has."""
    page.check(page.browser.execute_script("""
        return [...document.querySelectorAll(".box")].every(box => {
          const card = box.querySelector(".card").getBoundingClientRect();
          return [...box.querySelectorAll("text")].every(text => {
            const r = text.getBoundingClientRect();
            return r.left > card.left && r.right < card.right;
          }) && box.querySelector(".type").getBoundingClientRect().right < box.querySelector(".result").getBoundingClientRect().left;
        });"""), "a text leaves its box")


def main():
    directory = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as home:
        browser = start_browser(home)
        try:
            for name, look in (("fine.html", look_at_fine), ("failed.html", look_at_failed),
                               ("hostile.html", look_at_hostile), ("large.html", look_at_large),
                               ("folded.html", look_at_folded), ("empty.html", lambda page: None)):
                page = Page(browser, directory, name)
                no_overlaps(page)
                look(page)
                page.end()
        finally:
            browser.quit()
    for fault in faults:
        print(fault)
    return 1 if faults else 0


sys.exit(main())
