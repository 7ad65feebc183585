// Time of the page: what plays, and who follows it.

export class Player {
  constructor(duration) {
    this.duration = duration;
    this.t = 0;
    this.speed = 1;
    this.playing = false;
    /** Begins again at its end, as a mode does; a run plays once. */
    this.loops = false;
    this.followers = [];
    this.last = 0;
  }

  /** Calls `follower(t)` whenever time moves. */
  follow(follower) {
    this.followers.push(follower);
    follower(this.t);
  }

  seek(t) {
    this.t = Math.min(Math.max(t, 0), this.duration);
    for (const follower of this.followers) follower(this.t);
  }

  play(playing) {
    this.playing = playing;
    this.last = 0;
    if (playing) {
      if (this.t >= this.duration) this.seek(0);
      requestAnimationFrame((now) => this.tick(now));
    }
    if (!playing) {
      this.done?.();
      this.done = null;
    }
    this.changed?.();
  }

  /** Plays from the start to the end, stops there, and calls `done`, also if it is stopped before. */
  once(done) {
    this.seek(0);
    this.done = done;
    this.play(true);
  }

  tick(now) {
    if (!this.playing) return;
    // A page that was hidden continues where it was.
    const passed = this.last ? Math.min((now - this.last) / 1000, 0.1) : 0;
    this.last = now;
    const t = this.t + passed * this.speed;
    if (t >= this.duration && (this.done || !this.loops)) {
      this.seek(this.duration);
      this.play(false);
      return;
    }
    this.seek(t > this.duration ? 0 : t);
    requestAnimationFrame((next) => this.tick(next));
  }
}
