// The specs of the lessons of the manual: what one learns with is open with one click.
import { readFile, readdir } from "node:fs/promises";

const MANUAL = new URL("../../../docs/manual/", import.meta.url);
/** A page of a lesson: its number. */
const LESSON = /^lesson-(\d+)-.*\.md$/;
/** The first spec of a page. */
const SPEC = /<!-- file: (\S+) -->\n```yaml\n([^]*?)```/;

/** In order: number, name of the file, title, text. */
export async function lessons() {
  const pages = (await readdir(MANUAL)).flatMap((page) => (LESSON.test(page) ? [{ page, number: Number(LESSON.exec(page)[1]) }] : []));
  pages.sort((a, b) => a.number - b.number);
  return Promise.all(pages.map(async ({ page, number }) => {
    const [, name, text] = SPEC.exec(await readFile(new URL(page, MANUAL), "utf8"));
    return { number, name, title: /^title: (.*)$/m.exec(text)[1], text };
  }));
}
